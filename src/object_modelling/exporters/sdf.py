"""A model of Gazebo: model.config and model.sdf, with inertia and convex collision parts."""
import os
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from object_modelling import mesh_files
from object_modelling.exporters import bodies, files, textures

CONFIG = """<?xml version="1.0"?>
<model>
  <name>%s</name>
  <version>1.0</version>
  <sdf version="1.6">model.sdf</sdf>
  <author><name>object_modelling</name></author>
  <description>%s</description>
</model>
"""
COLLISION = """      <collision name="collision_%02d">
        <geometry><mesh><uri>%s</uri></mesh></geometry>
      </collision>
"""
MODEL = """<?xml version="1.0"?>
<sdf version="1.6">
  <model name=%(name)s>
    <pose>%(pose)s</pose>
    <link name="link">
      <inertial>
        <pose>%(center)s 0 0 0</pose>
        <mass>%(mass).9g</mass>
        <inertia>%(inertia)s</inertia>
      </inertial>
      <visual name="visual">
        <geometry><mesh><uri>%(visual)s</uri></mesh></geometry>
      </visual>
%(collisions)s    </link>
  </model>
</sdf>
"""


def _numbers(values):
    return " ".join("%.9g" % value for value in values)


def roll_pitch_yaw(rotation):
    """Of R = Rz(yaw) Ry(pitch) Rx(roll)."""
    pitch = np.arctan2(-rotation[2, 0], np.hypot(rotation[0, 0], rotation[1, 0]))
    if abs(rotation[2, 0]) > 1 - 1e-12:  # straight up or down: roll and yaw turn about one axis
        return 0.0, pitch, np.arctan2(-rotation[0, 1], rotation[1, 1])
    return np.arctan2(rotation[2, 1], rotation[2, 2]), pitch, np.arctan2(rotation[1, 0], rotation[0, 0])


def export(model, folder):
    inertia = bodies.inertia_of(model)
    root = escape("model://%s/meshes/" % model.id)
    visual = textures.write_obj(model.best_mesh(), os.path.join(folder, "meshes"), "visual")
    collisions = ""
    for number, mesh in enumerate(bodies.collision_meshes(model)):
        name = "collision_%02d.stl" % number
        files.write(os.path.join(folder, "meshes", name), mesh_files.stl(mesh))
        collisions += COLLISION % (number, root + name)
    standing = model.support_from_model[0] if model.support_from_model else np.eye(4)
    files.write(os.path.join(folder, "model.config"), CONFIG % (escape(model.id), escape(model.name)))
    files.write(os.path.join(folder, "model.sdf"), MODEL % {
        "name": quoteattr(model.id), "pose": _numbers([*standing[:3, 3], *roll_pitch_yaw(standing[:3, :3])]),
        "center": _numbers(inertia.center_m), "mass": inertia.mass_kg, "visual": root + visual,
        "inertia": "".join("<i%s>%.9g</i%s>" % (name, value, name) for name, value in inertia.entries()),
        "collisions": collisions})

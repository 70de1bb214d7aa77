"""A URDF of one link: textured mesh, inertia, convex collision parts."""
import os
from xml.sax.saxutils import quoteattr

from object_modelling import mesh_files
from object_modelling.exporters import bodies, files, textures

COLLISION = """    <collision>
      <geometry><mesh filename=%s/></geometry>
    </collision>
"""
ROBOT = """<?xml version="1.0"?>
<robot name=%(name)s>
  <link name=%(link)s>
    <inertial>
      <origin xyz="%(center)s" rpy="0 0 0"/>
      <mass value="%(mass).9g"/>
      <inertia %(inertia)s/>
    </inertial>
    <visual>
      <geometry><mesh filename=%(visual)s/></geometry>
    </visual>
%(collisions)s  </link>
</robot>
"""


def export(model, folder):
    inertia = bodies.inertia_of(model)
    visual = textures.write_obj(model.best_mesh(), os.path.join(folder, "meshes"), "visual")
    collisions = ""
    for number, mesh in enumerate(bodies.collision_meshes(model)):
        path = "meshes/collision_%02d.stl" % number
        files.write(os.path.join(folder, path), mesh_files.stl(mesh))
        collisions += COLLISION % quoteattr(path)
    files.write(os.path.join(folder, model.id + ".urdf"), ROBOT % {
        "name": quoteattr(model.id), "link": quoteattr(model.id), "visual": quoteattr("meshes/" + visual),
        "center": " ".join("%.9g" % value for value in inertia.center_m), "mass": inertia.mass_kg,
        "inertia": " ".join('i%s="%.9g"' % entry for entry in inertia.entries()), "collisions": collisions})

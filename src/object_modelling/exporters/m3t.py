"""A body of the tracker M3T (also ICG): OBJ and the YAML that describes it."""
import os

from object_modelling import mesh_files, meshes
from object_modelling.exporters import files

MAX_TRIANGLES = 20000  # its views are rendered thousands of times

# OpenCV's FileStorage reads it.
BODY = """%%YAML:1.0
---
geometry_path: "%s.obj"
geometry_unit_in_meter: 1.0
geometry_counterclockwise: 1
geometry_enable_culling: %d
geometry2body_pose: !!opencv-matrix
  rows: 4
  cols: 4
  dt: d
  data: [ 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1. ]
"""


def export(model, folder):
    mesh = model.mesh()
    closed = mesh.is_closed()  # through a hole the other side's back is seen
    mesh = meshes.decimated(mesh, MAX_TRIANGLES)
    mesh.colours = None  # it takes no more than the shape
    files.write(os.path.join(folder, model.id + ".obj"), mesh_files.obj(mesh))
    files.write(os.path.join(folder, model.id + ".yaml"), BODY % (model.id, closed))

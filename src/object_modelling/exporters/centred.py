"""The mesh with its bounding box about the origin (Open3D, ORK), as PLY, OBJ and STL in metres."""
import os

import numpy as np
import yaml

from object_modelling import mesh_files
from object_modelling.exporters import files, textures


def export(model, folder):
    low, high = model.mesh().bounds()
    centred_from_model = np.eye(4)
    centred_from_model[:3, 3] = -(low + high) / 2
    textures.write_obj(model.best_mesh().transformed(centred_from_model), folder, model.id)
    mesh = model.mesh().transformed(centred_from_model)
    files.write(os.path.join(folder, model.id + ".ply"), mesh_files.ply(mesh))
    files.write(os.path.join(folder, model.id + ".stl"), mesh_files.stl(mesh))
    frame = {"unit": "metre", "size_m": (high - low).tolist(), "centred_from_model": centred_from_model.tolist()}
    files.write(os.path.join(folder, "frame.yaml"), yaml.safe_dump(frame))

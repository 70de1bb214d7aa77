"""The mesh as binary glTF 2 with its texture inside, in metres."""
import os

from object_modelling import mesh_files
from object_modelling.exporters import files


def export(model, folder):
    files.write(os.path.join(folder, model.id + ".glb"), mesh_files.glb(model.best_mesh()))

"""The mesh as binary STL, shape alone."""
import os

from object_modelling import mesh_files
from object_modelling.exporters import files

UNITS = {"m": 1.0, "mm": 1000.0}


def export(model, folder, unit="m"):
    files.write(os.path.join(folder, model.id + ".stl"), mesh_files.stl(model.mesh().scaled(UNITS[unit])))

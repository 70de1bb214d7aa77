"""The mesh as PLY, with vertex colours, texture coordinates and the texture as PNG."""
from object_modelling.exporters import textures

UNITS = {"m": 1.0, "mm": 1000.0}


def export(model, folder, unit="m"):
    textures.write_ply(model.best_mesh().scaled(UNITS[unit]), folder, model.id)

"""Writes a mesh with its texture as the files that belong together."""
import os

import cv2
import numpy as np

from object_modelling import mesh_files
from object_modelling.exporters import files


def write_obj(mesh, folder, name):
    """name.obj, and with a texture name.mtl and name.png; returns the file name of the mesh."""
    if mesh.texture is None:
        files.write(os.path.join(folder, name + ".obj"), mesh_files.obj(mesh))
    else:
        files.write(os.path.join(folder, name + ".obj"), mesh_files.obj(mesh, name + ".mtl"))
        files.write(os.path.join(folder, name + ".mtl"), mesh_files.mtl(name + ".png"))
        files.write(os.path.join(folder, name + ".png"), mesh_files.png(mesh.texture))
    return name + ".obj"


def write_ply(mesh, folder, name):
    """name.ply, and with a texture name.png: its colours stand at the vertices, too. Returns the file name."""
    if mesh.texture is None:
        files.write(os.path.join(folder, name + ".ply"), mesh_files.ply(mesh))
    else:
        mesh.colours = colours_at(mesh.texture, mesh.uv)
        files.write(os.path.join(folder, name + ".ply"), mesh_files.ply(mesh, name + ".png"))
        files.write(os.path.join(folder, name + ".png"), mesh_files.png(mesh.texture))
    return name + ".ply"


def colours_at(texture, uv):
    """n x 3, RGB: bilinear between texels, v upwards."""
    height, width = texture.shape[:2]
    columns = (uv[:, 0] * width - 0.5).astype(np.float32)
    rows = ((1 - uv[:, 1]) * height - 0.5).astype(np.float32)
    found = np.empty((len(uv), 3), np.uint8)
    step = 30000  # cv2.remap takes no more than 32767 rows
    for first in range(0, len(uv), step):
        part = slice(first, first + step)
        found[part] = cv2.remap(texture, columns[part, None], rows[part, None], cv2.INTER_LINEAR,
                                borderMode=cv2.BORDER_REPLICATE)[:, 0]
    return found[:, ::-1]

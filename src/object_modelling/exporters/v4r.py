"""A model of V4R's recognisers: views/ and 3D_model.pcd."""
import os

from object_modelling.exporters import files

KINDS = (("cloud", "pcd"), ("pose", "txt"), ("object_indices", "txt"), ("image", "jpg"))


def export(model, folder):
    for view in model.views:
        for kind, extension in KINDS:
            path = view.path(kind, extension)
            files.copy(path, os.path.join(folder, "views", os.path.basename(path)))
    files.copy(model.path("cloud.pcd"), os.path.join(folder, "3D_model.pcd"))

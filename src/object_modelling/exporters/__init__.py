"""Object models as files for other programs; docs/exports.md.

Each format is a module with `export(model, folder)`, which writes a model into a new or kept folder and returns what is
worth saying of it (or None). Its docstring's first line describes it. `UNITS`: export() takes a unit, too. `SHARED`:
one folder holds all objects, otherwise each has its own; `KEPT`: the files of it that outlive its objects.
"""
from object_modelling.exporters import (bop, centred, foundationpose, glb, grasping_pipeline, m3t, moveit, obj, ply,
                                        sdf, stl, urdf, v4r)

FORMATS = {"bop": bop, "urdf": urdf, "sdf": sdf, "moveit": moveit, "ply": ply, "obj": obj, "glb": glb, "stl": stl,
           "v4r": v4r, "grasping_pipeline": grasping_pipeline, "foundationpose": foundationpose, "m3t": m3t,
           "centred": centred}

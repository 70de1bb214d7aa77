"""Reference views and mesh for FoundationPose and BundleSDF."""
import collections
import os

import numpy as np
import yaml

from object_modelling import mesh_files
from object_modelling.exporters import files, textures
from object_modelling.outcome import Code, Failure

MM_OF_M = 1000
MAX_DEPTH_MM = 65535
# run_nerf.py of FoundationPose names two of the folders differently from its demo.
ALIASES = (("depth_enhanced", "depth"), ("mask", "masks"))


def export(model, folder):
    if not model.views:
        raise Failure(Code.FAILED_PRECONDITION, "object '%s' has no views, which this format consists of: build it "
                      "anew" % model.id)
    camera, views = _views_of_one_camera(model.views)
    for name in ("K.txt", "cam_K.txt"):
        files.write(os.path.join(folder, name), _matrix_text(camera))
    for number, view in enumerate(views):
        colour, depth_m = view.images()
        depth_mm = np.round(depth_m * MM_OF_M)
        depth_mm[depth_mm > MAX_DEPTH_MM] = 0
        name = "%06d" % number
        files.write(os.path.join(folder, "rgb", name + ".png"), mesh_files.png(colour))
        files.write(os.path.join(folder, "depth", name + ".png"), mesh_files.png(depth_mm.astype(np.uint16)))
        files.write(os.path.join(folder, "masks", name + ".png"), mesh_files.png(view.object_mask()))
        files.write(os.path.join(folder, "cam_in_ob", name + ".txt"), _matrix_text(view.model_from_camera()))
        view.forget_images()
    for alias, name in ALIASES:
        os.symlink(name, os.path.join(folder, alias))
    files.write(os.path.join(folder, "select_frames.yml"), yaml.safe_dump({"frames": list(range(len(views)))}))
    textures.write_obj(model.best_mesh(), os.path.join(folder, "mesh"), "textured")
    left_out = len(model.views) - len(views)
    return ["object '%s': %d of %d views are left out, as the format has one camera for all" % (
        model.id, left_out, len(model.views))] if left_out else None


def _views_of_one_camera(views):
    """(camera matrix, views): of the camera that most views have."""
    by_camera = collections.OrderedDict()
    for view in views:
        by_camera.setdefault((view.size_px, view.camera_matrix.tobytes()), []).append(view)
    most = max(by_camera.values(), key=len)
    return most[0].camera_matrix, most


def _matrix_text(matrix):
    return "".join(" ".join("%.17g" % value for value in row) + "\n" for row in matrix)

"""A data set of the BOP benchmark: models, models_eval, models_info, static onboarding sequences; mm."""
import glob
import json
import os
import shutil

import cv2
import numpy as np
import yaml

from object_modelling import database, mesh_files, meshes
from object_modelling.exporters import files, symmetries, textures

SHARED = True
IDS = "object_ids.yaml"
KEPT = (IDS,)
MM_OF_M = 1000.0
MAX_EVAL_TRIANGLES = 10000
FINE_DEPTH_SCALE, COARSE_DEPTH_SCALE = 0.1, 1.0  # mm for 1 in the images
MAX_DEPTH_VALUE = 65535
SUBPIXEL_BITS = 4
SEQUENCES = ("up", "down")  # of the first session and the second


def export(model, folder):
    number = _number_of(model.id, folder)
    name = "obj_%06d" % number
    for old in glob.glob(os.path.join(glob.escape(folder), "*", name + "*")):
        shutil.rmtree(old) if os.path.isdir(old) else os.remove(old)
    textures.write_ply(model.best_mesh().scaled(MM_OF_M), os.path.join(folder, "models"), name)
    mesh = model.mesh()
    reduced = meshes.decimated(mesh, MAX_EVAL_TRIANGLES)
    files.write(os.path.join(folder, "models_eval", name + ".ply"), mesh_files.ply(reduced.scaled(MM_OF_M)))
    for models in ("models", "models_eval"):
        _update_json(os.path.join(folder, models, "models_info.json"), str(number), _info(model, mesh))
    return _write_sequences(model, reduced, number, os.path.join(folder, "onboarding_static", name))


def _number_of(object_id, folder):
    """The number that an object has had before; new ones come after all others, from 1."""
    path = os.path.join(folder, IDS)
    numbers = database.load_yaml(path) if os.path.isfile(path) else {}
    numbers.setdefault(object_id, max(numbers.values(), default=0) + 1)
    files.write(path, yaml.safe_dump(numbers))
    return numbers[object_id]


def _update_json(path, key, value):
    content = {}
    if os.path.isfile(path):
        with open(path, encoding="utf-8") as text:
            content = json.load(text)
    content[key] = value
    ordered = {name: content[name] for name in sorted(content, key=int)}
    files.write(path, json.dumps(ordered, indent=2) + "\n")


def _info(model, mesh):
    """Symmetries that texture, too, cannot resolve: as BOP counts them."""
    low, high = (corner * MM_OF_M for corner in mesh.bounds())
    info = {"diameter": model.diameter_m * MM_OF_M}
    info.update(("min_" + axis, float(low[i])) for i, axis in enumerate("xyz"))
    info.update(("size_" + axis, float(high[i] - low[i])) for i, axis in enumerate("xyz"))
    of_texture = [symmetry for symmetry in model.symmetries if symmetry["of"] == "texture"]
    turns = symmetries.discrete(of_texture)
    for turn in turns:
        turn[:3, 3] *= MM_OF_M
    if turns:
        info["symmetries_discrete"] = [turn.reshape(-1).tolist() for turn in turns]
    axes = symmetries.continuous(of_texture)
    if axes:
        info["symmetries_continuous"] = [{"axis": axis.tolist(), "offset": (MM_OF_M * point).tolist()}
                                         for axis, point in axes]
    return info


def _write_sequences(model, mesh, number, prefix):
    sessions = [session for session in model.session_ids + [None] if any(v.session == session for v in model.views)]
    for session, which in zip(sessions, SEQUENCES):
        views = [view for view in model.views if view.session == session]
        _write_sequence(views, mesh, number, prefix + "_" + which)
        _write_camera(views[0], os.path.join(os.path.dirname(prefix), "..", "camera.json"))
    left_out = sessions[len(SEQUENCES):]
    return ["object '%s': the views of session '%s' are left out, as BOP has two sequences for an object" % (
        model.id, "', '".join(map(str, left_out)))] if left_out else None


def _write_camera(view, path):
    camera = view.camera_matrix
    content = {"cx": camera[0, 2], "cy": camera[1, 2], "fx": camera[0, 0], "fy": camera[1, 1],
               "width": view.size_px[0], "height": view.size_px[1], "depth_scale": FINE_DEPTH_SCALE}
    files.write(os.path.normpath(path), json.dumps(content, indent=2) + "\n")


def _write_sequence(views, mesh, number, folder):
    cameras, poses, infos = {}, {}, {}
    for i, view in enumerate(views):
        colour, depth_m = view.images()
        depth_mm = depth_m * MM_OF_M
        scale = FINE_DEPTH_SCALE if depth_mm.max() <= FINE_DEPTH_SCALE * MAX_DEPTH_VALUE else COARSE_DEPTH_SCALE
        values = np.round(depth_mm / scale)
        values[values > MAX_DEPTH_VALUE] = 0
        camera_from_model = view.camera_from_model()
        silhouette = silhouette_of(mesh, view.camera_matrix @ camera_from_model[:3], view.size_px)
        visible = view.object_mask()
        for kind, name, image in (("rgb", "%06d", colour), ("depth", "%06d", values.astype(np.uint16)),
                                  ("mask", "%06d_000000", silhouette), ("mask_visib", "%06d_000000", visible)):
            files.write(os.path.join(folder, kind, name % i + ".png"), mesh_files.png(image))
        cameras[i] = {"cam_K": view.camera_matrix.reshape(-1).tolist(), "depth_scale": scale}
        poses[i] = [{"cam_R_m2c": camera_from_model[:3, :3].reshape(-1).tolist(),
                     "cam_t_m2c": (MM_OF_M * camera_from_model[:3, 3]).tolist(), "obj_id": number}]
        infos[i] = [_visibility(silhouette, visible, depth_m)]
        view.forget_images()
    for name, content in (("scene_camera", cameras), ("scene_gt", poses), ("scene_gt_info", infos)):
        files.write(os.path.join(folder, name + ".json"), json.dumps(content, indent=1) + "\n")


def silhouette_of(mesh, image_from_model, size_px):
    """255 where a triangle of the mesh falls, whatever stands before it. image_from_model: 3x4, pixels."""
    points = mesh.vertices @ image_from_model[:, :3].T + image_from_model[:, 3]
    in_front = (points[:, 2] > 0)[mesh.triangles].all(1)
    pixels = points[:, :2] / np.where(points[:, 2:] > 0, points[:, 2:], 1)
    corners = np.round(pixels * 2 ** SUBPIXEL_BITS).astype(np.int32)[mesh.triangles[in_front]]
    mask = np.zeros(size_px[::-1], np.uint8)
    for triangle in corners:
        cv2.fillConvexPoly(mask, triangle, 255, cv2.LINE_8, SUBPIXEL_BITS)
    return mask


def _visibility(silhouette, visible, depth_m):
    count = int(np.count_nonzero(silhouette))
    count_visible = int(np.count_nonzero(visible & silhouette))
    return {"bbox_obj": _box(silhouette), "bbox_visib": _box(visible), "px_count_all": count,
            "px_count_valid": int(np.count_nonzero(depth_m[silhouette > 0])), "px_count_visib": count_visible,
            "visib_fract": count_visible / count if count else 0.0}


def _box(mask):
    """x, y, width, height in pixels; -1 each of nothing, as BOP has it."""
    return list(cv2.boundingRect(mask)) if mask.any() else [-1] * 4

"""Reads the object database; docs/object_database.md. Everything raises Failure."""
import os

import numpy as np
import yaml

from object_modelling import mesh_files, pcd
from object_modelling.outcome import Code, Failure

SCHEMA_VERSIONS = (1, 2)


def load_yaml(path):
    """The map of a YAML file."""
    try:
        with open(path, encoding="utf-8") as text:
            data = yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise Failure(Code.BAD_INPUT, "%s cannot be read: %s; build the object anew" % (path, error)) from error
    if not isinstance(data, dict):
        raise Failure(Code.BAD_INPUT, "%s is no description of an object; build the object anew" % path)
    return data


class View:
    """A keyframe that the model was made from: rectified images and pose."""

    def __init__(self, folder, entry, session):
        self.index = int(entry["index"])
        self.session = session  # id; None where the database does not tell
        self.stamp_s = float(entry["stamp_s"])
        self.size_px = (int(entry["width_px"]), int(entry["height_px"]))
        self.camera_matrix = np.array([[entry["fx_px"], 0, entry["cx_px"]], [0, entry["fy_px"], entry["cy_px"]],
                                       [0, 0, 1]], float)
        self._folder = folder
        self._images = None

    def path(self, kind, extension):
        return os.path.join(self._folder, "%s_%08d.%s" % (kind, self.index, extension))

    def model_from_camera(self):
        """4x4, camera optical frame."""
        try:
            matrix = np.loadtxt(self.path("pose", "txt")).reshape(4, 4)
        except (OSError, ValueError) as error:
            raise self._damaged("pose", "txt", error) from error
        return matrix

    def camera_from_model(self):
        return np.linalg.inv(self.model_from_camera())

    def images(self):
        """(colour BGR, depth in metres with 0 where missing)"""
        if self._images is None:
            columns, size_px = pcd.read(self.path("cloud", "pcd"))
            if size_px != self.size_px or not {"z", "rgb"} <= set(columns):
                raise self._damaged("cloud", "pcd", "%d x %d points do not fit the camera" % size_px)
            shape = size_px[::-1]
            depth_m = np.nan_to_num(columns["z"]).reshape(shape)
            self._images = pcd.colours(columns["rgb"])[:, ::-1].reshape(shape + (3,)), depth_m
        return self._images

    def forget_images(self):
        """Frees the memory; they are read again when they are asked for again."""
        self._images = None

    def object_mask(self):
        """255 where a pixel with depth shows the object."""
        mask = np.zeros(self.size_px[0] * self.size_px[1], np.uint8)
        try:
            with open(self.path("object_indices", "txt")) as text:
                mask[np.array(text.read().split(), np.int64)] = 255
        except (OSError, ValueError, IndexError) as error:
            raise self._damaged("object_indices", "txt", error) from error
        return mask.reshape(self.size_px[::-1])

    def _damaged(self, kind, extension, error):
        return Failure(Code.BAD_INPUT, "%s cannot be read: %s; build the object anew" % (
            self.path(kind, extension), error))


class ObjectModel:
    """One object; geometry and images are read when they are asked for. Metres, in the object frame."""

    def __init__(self, folder):
        self.folder = folder
        self.description = load_yaml(os.path.join(folder, "object.yaml"))
        version = self.description.get("schema_version")
        if version not in SCHEMA_VERSIONS:
            raise Failure(Code.STORAGE, "%s has schema version %s, but this program knows %s: use a newer one" % (
                folder, version, " and ".join(map(str, SCHEMA_VERSIONS))))
        try:
            self._take(self.description)
        except (KeyError, TypeError, ValueError) as error:
            raise Failure(Code.BAD_INPUT, "%s/object.yaml lacks %s; build the object anew" % (folder, error)) from error

    def _take(self, entry):
        self.id, self.name = str(entry["id"]), str(entry["name"])
        self.size_m = np.array(entry["size_m"], float).reshape(3)
        self.diameter_m = float(entry["diameter_m"])
        self.model_from_box = np.array(entry["model_from_box"], float).reshape(4, 4)
        self.support_from_model = [np.array(pose, float).reshape(4, 4) for pose in entry["support_from_model"]]
        self.session_ids = [str(session["id"]) for session in entry["sessions"]]
        self.mass_properties = entry.get("mass_properties")
        self.symmetries = entry.get("symmetries") or []
        sessions = self._sessions_of_views(entry["views"])
        self.views = [View(self.path("views"), view, session) for view, session in zip(entry["views"], sessions)]

    def _sessions_of_views(self, views):
        """Files of before tell it in quality.yaml alone."""
        if all("session" in view for view in views):
            return [str(view["session"]) for view in views]
        if len(self.session_ids) == 1:
            return self.session_ids * len(views)
        try:
            quality = load_yaml(self.path("quality.yaml"))
            by_index = {view["index"]: str(view["session_id"]) for view in quality["views"]}
            return [by_index[view["index"]] for view in views]
        except (Failure, KeyError, TypeError):
            return [None] * len(views)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def mesh(self):
        """With vertex colours, without texture."""
        return mesh_files.read_ply(self.path("mesh", "mesh.ply"))

    def textured_mesh(self):
        """None where the model has no texture."""
        path = self.path("mesh", "textured.glb")
        return mesh_files.read_glb(path) if os.path.isfile(path) else None

    def best_mesh(self):
        """With a texture where there is one."""
        return self.textured_mesh() or self.mesh()

    def collision_parts(self):
        """Convex meshes that cover the object together; none where the database has none."""
        count = int(self.description.get("collision_parts") or 0)
        return [mesh_files.read_ply(self.path("mesh", "collision_%02d.ply" % i)) for i in range(count)]


class Database:
    """The folder of a database."""

    def __init__(self, root):
        self.root = os.path.abspath(os.path.expanduser(root))
        path = os.path.join(self.root, "manifest.yaml")
        if not os.path.isfile(path):
            raise Failure(Code.NOT_FOUND, "'%s' is no object database, as it has no manifest.yaml: name the folder "
                          "that was given as --database when the objects were built" % root)
        manifest = load_yaml(path)
        if manifest.get("schema_version") not in SCHEMA_VERSIONS:
            raise Failure(Code.STORAGE, "%s has schema version %s, but this program knows %s: use a newer one" % (
                path, manifest.get("schema_version"), " and ".join(map(str, SCHEMA_VERSIONS))))
        try:
            self._hashes = {str(entry["id"]): str(entry["content_hash"]) for entry in manifest["objects"] or []}
        except (KeyError, TypeError) as error:
            raise Failure(Code.BAD_INPUT, "%s lacks %s: see 'object_modelling info %s'" % (path, error, root)) \
                from error

    def object_ids(self):
        return sorted(self._hashes)

    def content_hash(self, object_id):
        return self._hashes[object_id]

    def object(self, object_id):
        if object_id not in self._hashes:
            raise Failure(Code.NOT_FOUND, "database '%s' has no object '%s': it has %s" % (
                self.root, object_id, ", ".join("'%s'" % known for known in self.object_ids()) or "none"))
        return ObjectModel(os.path.join(self.root, object_id))

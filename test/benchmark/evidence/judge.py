"""Whether a pose found for two sessions is right: within limits of the true one, or of one that makes the same object.

An object may be symmetric, in shape or in shape and texture; then any pose that makes the same object is right. That is
read off the true mesh and its texture, not off a list.
"""

import numpy as np
from evalkit.mesh import ClosestPoint, load_mesh
from scipy.spatial import cKDTree

MIN_TOLERANCE_M, TOLERANCE_DIAMETERS = 0.0015, 0.02
KIT_DIAMETERS = 0.1  # the limit of the kit's score_alignment.py
SAMPLES, DENSE_SAMPLES = 1500, 30000
BLUR_M, BLUR_NEIGHBOURS = 0.006, 40
# Of a surface that slid along itself most points still lie on it, and a handle is few of the points: almost all must fit.
STRAY_QUANTILE, STRAY_TOLERANCES = 0.98, 1.25
MEAN_COLOR, PARTS_COLOR, PARTS_QUANTILE = 8.0, 40.0, 0.95  # grey levels; the latter over the worst parts


def surface_colours(mesh, faces, barycentrics):
    """RGB (n, 3), 0 to 255, of points on a mesh."""
    if mesh.colours is not None:
        return np.einsum("nk,nkc->nc", barycentrics, mesh.colours[mesh.faces[faces]].astype(float))
    if mesh.texture is None or mesh.uv is None:
        return np.tile(255 * np.asarray(mesh.base_colour, float), (len(faces), 1))
    uv = np.einsum("nk,nkc->nc", barycentrics, mesh.uv[faces])
    height, width = mesh.texture.shape[:2]
    column = np.clip((uv[:, 0] % 1.0) * width, 0, width - 1).astype(int)
    row = np.clip((1 - uv[:, 1] % 1.0) * height, 0, height - 1).astype(int)
    return mesh.texture[row, column].astype(float)


class TrueObject:
    """What judging needs of a mesh, sampled with the same seed each time."""

    def __init__(self, path):
        mesh = load_mesh(path)
        self.diameter_m = mesh.diameter()
        self.tolerance_m = max(MIN_TOLERANCE_M, TOLERANCE_DIAMETERS * self.diameter_m)
        self.closest = ClosestPoint(mesh)
        dense, self.dense_normals, faces, barycentrics = mesh.sample(DENSE_SAMPLES, np.random.default_rng(1))
        self.tree = cKDTree(dense)
        self.blurred = self._blurred(dense, surface_colours(mesh, faces, barycentrics))
        self.points, self.normals, _, _ = mesh.sample(SAMPLES, np.random.default_rng(0))
        self.colours = self._colours_at(self.points, self.normals)

    def _blurred(self, points, colours):
        near, index = self.tree.query(points, BLUR_NEIGHBOURS, distance_upper_bound=BLUR_M)
        there = np.isfinite(near)
        index[~there] = 0
        same_side = np.einsum("nkc,nc->nk", self.dense_normals[index], self.dense_normals) > 0.5
        weight = (there & same_side).astype(float)
        return (weight[:, :, None] * colours[index]).sum(1) / np.maximum(weight.sum(1), 1)[:, None]

    def _colours_at(self, points, normals):
        """Colours of the nearest surface that faces the same way."""
        _, index = self.tree.query(points, 16)
        same_side = np.einsum("nkc,nc->nk", self.dense_normals[index], normals) > 0.5
        return self.blurred[index[np.arange(len(points)), same_side.argmax(1)]]

    def errors(self, error):
        """Errors of a pose that maps the object to `error` (4x4) instead of to itself: ADD and ADD-S in metres, whether
        it makes the same shape, and the same shape with the same texture."""
        moved = self.points @ error[:3, :3].T + error[:3, 3]
        add = float(np.linalg.norm(moved - self.points, axis=1).mean())
        distance = self.closest.query(moved)[0]
        same_shape = np.quantile(distance, STRAY_QUANTILE) <= STRAY_TOLERANCES * self.tolerance_m
        difference = np.abs(self._colours_at(moved, self.normals @ error[:3, :3].T) - self.colours).mean(1)
        same_texture = difference.mean() <= MEAN_COLOR and np.quantile(difference, PARTS_QUANTILE) <= PARTS_COLOR
        return {"add_m": add, "adds_m": float(distance.mean()), "same_shape": bool(same_shape),
                "same_object": bool(same_shape and same_texture)}

    def is_right(self, errors, shape_only=False):
        return errors["add_m"] <= self.tolerance_m or errors["same_shape" if shape_only else "same_object"]


class Judge:
    """Adds to the candidates of benchmark_alignment's JSON whether each is right."""

    def __init__(self):
        self._objects = {}

    def object(self, mesh):
        if mesh not in self._objects:
            self._objects[mesh] = TrueObject(mesh)
        return self._objects[mesh]

    def judge(self, report):
        """Sets `right`, `add_m`, `adds_m` of every candidate of pairs of one object; returns the report."""
        sessions = {s["id"]: s for s in report["sessions"] if not s["problem"]}
        for pair in report["pairs"]:
            for candidate in pair["candidates"] + [c for c in [pair.get("from_truth")] if c]:
                if not pair["same_object"]:
                    candidate["right"] = False
                    continue
                a, b = sessions[pair["a"]], sessions[pair["b"]]
                true = self.object(a["mesh"])
                error = (np.linalg.inv(np.array(a["session_from_object"])) @ np.array(candidate["a_from_b"])
                         @ np.array(b["session_from_object"]))
                errors = true.errors(error)
                candidate["right"] = true.is_right(errors, report["options"]["grey"])
                candidate.update(add_m=errors["add_m"], adds_m=errors["adds_m"])
                candidate["right_in_kit"] = candidate["right"] or errors["add_m"] < KIT_DIAMETERS * true.diameter_m
        for row in report.get("objects", []):
            row["right"] = self.right_together(row, sessions, report["options"]["grey"])
        return report

    def right_together(self, row, sessions, shape_only=False):
        """The largest group of an object's placed sessions that lie right to one of them; none if that is one alone."""
        placed = {s: np.array(pose) for s, pose in row["reference_from_session"].items()}
        truth = {s: np.array(sessions[s]["session_from_object"]) for s in placed}
        largest = []
        for first in placed:
            true = self.object(sessions[first]["mesh"])
            group = [s for s in placed if s == first or true.is_right(true.errors(
                np.linalg.inv(placed[first] @ truth[first]) @ placed[s] @ truth[s]), shape_only)]
            largest = max(largest, group, key=len)
        return largest if len(largest) > 1 else []

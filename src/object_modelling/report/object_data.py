"""The report's contents, read from an object's folder."""
import os

from object_modelling.database import load_yaml
from object_modelling.outcome import Failure

# Limits of the traffic lights, on root mean squares over a keyframe's observations after bundle adjustment.
GREEN_PX, AMBER_PX = 0.5, 1.0
GREEN_M, AMBER_M = 0.003, 0.006
FEW_OBSERVATIONS = 20


class ReportError(Exception):
    """Why there is no report; the message names the thing and the remedy."""


class Keyframe:
    """One keyframe of a session and how well it fits the others."""

    def __init__(self, session_id, keyframe_id, residual=None, left_out=False, position_m=None):
        self.session_id = session_id
        self.keyframe_id = keyframe_id
        self.residual = residual
        self.left_out = left_out
        self.position_m = position_m

    @property
    def light(self):
        """green, amber, red, or grey where nothing was measured."""
        if self.left_out:
            return "red"
        if self.residual is None:
            return "grey"
        pixels, metres = self.residual["reprojection_rmse_after_px"], self.residual["depth_rmse_after_m"]
        if pixels > AMBER_PX or metres > AMBER_M:
            return "red"
        if pixels > GREEN_PX or metres > GREEN_M or self.residual["observation_count"] < FEW_OBSERVATIONS:
            return "amber"
        return "green"

    @property
    def reason(self):
        if self.left_out:
            return "left out of the bundle adjustment: nothing links it to the others"
        if self.residual is None:
            return "not refined"
        r = self.residual
        return "%d observations; %.2f px (before %.2f), %.2f mm (before %.2f)" % (
            r["observation_count"], r["reprojection_rmse_after_px"], r["reprojection_rmse_before_px"],
            1000 * r["depth_rmse_after_m"], 1000 * r["depth_rmse_before_m"])


class ObjectData:
    """folder: an object's folder. Raises ReportError."""

    def __init__(self, folder):
        self.folder = folder
        self.object = _load(os.path.join(folder, "object.yaml"))
        self.quality = self._quality()
        try:
            self.keyframes = _keyframes(self.quality)
            self.id, self.name = str(self.object["id"]), str(self.object["name"])
            # Objects of before lack it.
            self.left_out = [(str(session["id"]), str(session["reason"]))
                             for session in self.object.get("sessions_left_out", [])]
            self.properties = _properties(self.object)
        except (KeyError, TypeError, AttributeError) as error:
            raise ReportError("%s: quality.yaml or object.yaml lacks %s; build the object anew" % (folder, error)) \
                from error

    def _quality(self):
        path = os.path.join(self.folder, "quality.yaml")
        if not os.path.exists(path) and "imported_mesh" in (self.object.get("provenance") or {}):
            raise ReportError("%s has no quality.yaml, which a report is made of: the object was imported from a mesh "
                              "file, so no recording and no build is there to report on; 'object_modelling info' tells "
                              "its size and properties" % self.folder)
        return _load(path)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def count(self, light):
        return sum(keyframe.light == light for keyframe in self.keyframes)


def _load(path):
    try:
        return load_yaml(path)
    except Failure as failure:
        raise ReportError(failure.message) from failure


def _properties(description):
    """Rows (title, text) of what is known of the object; none for objects of before."""
    mass = description.get("mass_properties")
    if mass is None:
        return []
    of = {"mesh": "", "closed_mesh": ", holes closed", "hull": ", of the hull"}[mass["of"]]
    turns = {"shape": [], "texture": []}
    for symmetry in description["symmetries"]:
        turns[symmetry["of"]].append("round" if symmetry["kind"] == "continuous" else "%d-fold" % symmetry["order"])
    poses = ["%.0f %%%s" % (100 * pose["probability"], " (recorded)" if pose["seen"] else "")
             for pose in description["resting_poses"]]
    rows = [("Volume", "%.0f ml%s" % (1e6 * mass["volume_m3"], of)),
            ("Symmetries", "%s; with texture: %s" % tuple(", ".join(turns[of]) or "none"
                                                          for of in ("shape", "texture"))),
            ("Resting poses", ", ".join(poses) or "none")]
    if "unseen" in description:
        unseen = description["unseen"]
        # Where the mesh is open at the bottom, that is no share of its surface.
        bottom = "; the bottom was not seen%s" % ("" if mass["closed"] else ", and may be open")
        rows.append(("Never seen", "%.0f %% of the mesh%s" % (
            100 * unseen["ratio"], bottom if unseen["bottom"] else "")))
    return rows


def _keyframes(quality):
    """Those that the bundle adjustment had, and the views of the model; by session and id."""
    found = {}
    for session in quality["sessions"]:
        refinement = session["refinement"] or {"keyframes": [], "left_out": []}
        for residual in refinement["keyframes"]:
            key = (session["id"], residual["keyframe_id"])
            found[key] = Keyframe(*key, residual, residual["keyframe_id"] in refinement["left_out"])
    for view in quality["views"]:
        key = (view["session_id"], view["keyframe_id"])
        found.setdefault(key, Keyframe(*key)).position_m = view["camera_position_m"]
    return [found[key] for key in sorted(found)]

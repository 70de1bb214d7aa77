"""The rotations under which an object stays the same, from the axes that the database has."""
import numpy as np

MAX_ELEMENTS = 120  # of a finite group of rotations that is not that of a prism: an icosahedron has 60
SAME_RAD = 0.02


def rotation_about(axis, angle_rad):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * cross @ cross


def about_point(rotation, point):
    transform = np.eye(4)
    transform[:3, :3] = rotation
    transform[:3, 3] = np.asarray(point, float) - rotation @ np.asarray(point, float)
    return transform


def discrete(symmetries):
    """4x4 transforms but the identity: all products of the turns about the discrete axes. Metres."""
    turns = [about_point(rotation_about(s["axis"], 2 * np.pi / s["order"]), s["point_m"])
             for s in symmetries if s["kind"] == "discrete" and s["order"] > 1]
    found, front = [np.eye(4)], [np.eye(4)]
    while front and len(found) < MAX_ELEMENTS:
        reached = []
        for transform in (turn @ known for known in front for turn in turns):
            if all(_angle_between(transform, known) > SAME_RAD for known in found + reached):
                reached.append(transform)
        found, front = found + reached, reached
    return found[1:]


def _angle_between(a, b):
    return np.arccos(np.clip((np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2, -1, 1))


def continuous(symmetries):
    """(unit axis, point on it in metres) each"""
    return [(np.asarray(s["axis"], float) / np.linalg.norm(s["axis"]), np.asarray(s["point_m"], float))
            for s in symmetries if s["kind"] == "continuous"]

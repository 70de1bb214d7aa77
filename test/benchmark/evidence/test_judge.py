"""A pose is right that is the true one, or makes the same object."""

import numpy as np
import pytest
from judge import Judge, TrueObject


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """A box 60 x 60 x 100 mm, of which one side is red and the others are grey."""
    x, y, z = 0.03, 0.03, 0.05
    path = tmp_path_factory.mktemp("box") / "textured.ply"
    faces = [((x, 0, 0), (0, y, 0), (0, 0, z)), ((-x, 0, 0), (0, 0, z), (0, y, 0)), ((0, y, 0), (0, 0, z), (x, 0, 0)),
             ((0, -y, 0), (x, 0, 0), (0, 0, z)), ((0, 0, z), (x, 0, 0), (0, y, 0)), ((0, 0, -z), (0, y, 0), (x, 0, 0))]
    vertices, triangles = [], []
    for number, (centre, u, v) in enumerate(np.array(faces)):
        colour = "200 30 30" if number == 0 else "120 120 120"
        triangles += [f"3 {len(vertices)} {len(vertices) + 1} {len(vertices) + 2}",
                      f"3 {len(vertices)} {len(vertices) + 2} {len(vertices) + 3}"]
        vertices += ["%f %f %f " % tuple(centre + a * u + b * v) + colour for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    path.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
                    + "\n".join(vertices + triangles) + "\n")
    return TrueObject(str(path))


def turned(axis, degrees, shift=(0, 0, 0)):
    pose = np.eye(4)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = {"x": (1, 2), "z": (0, 1)}[axis]
    pose[i, i] = pose[j, j] = c
    pose[i, j], pose[j, i] = -s, s
    pose[:3, 3] = shift
    return pose


def test_the_true_pose_is_right_and_one_beside_it_is_not(box):
    assert box.is_right(box.errors(np.eye(4)))
    assert box.is_right(box.errors(turned("z", 1.5, (0.001, 0, 0))))
    assert not box.is_right(box.errors(turned("z", 0, (0.006, 0, 0))))
    assert not box.is_right(box.errors(turned("x", 10)), shape_only=True)


def test_a_turn_that_the_print_forbids_is_right_by_shape_alone(box):
    quarter, over = turned("z", 90), turned("x", 180)
    assert not box.is_right(box.errors(quarter)), "the red side is elsewhere"
    assert box.is_right(box.errors(quarter), shape_only=True)
    assert box.is_right(box.errors(over)), "the red side stays where it is"
    assert not box.is_right(box.errors(turned("x", 90)), shape_only=True), "the box is longer than wide"


def test_of_sessions_placed_together_the_largest_group_that_fits_is_right(box):
    judge = Judge()
    judge._objects["box.ply"] = box
    truth = {"a": np.eye(4), "b": turned("z", 30), "c": turned("x", 70, (0.1, 0, 0))}
    sessions = {s: {"mesh": "box.ply", "session_from_object": pose.tolist()} for s, pose in truth.items()}

    def right(**off):
        placed = {s: off.get(s, np.eye(4)) @ np.linalg.inv(pose) for s, pose in truth.items()}
        return judge.right_together({"reference_from_session": placed}, sessions)

    assert right() == ["a", "b", "c"]
    assert right(b=turned("x", 180)) == ["a", "b", "c"], "the red side stays where it is"
    assert right(a=turned("z", 90)) == ["b", "c"], "the first one is the wrong one"
    assert right(a=turned("z", 90), b=turned("x", 90)) == []

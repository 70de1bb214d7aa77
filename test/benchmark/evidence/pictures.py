"""Pictures of pairs: both parts as they were put together, and as they belong together."""

import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of the backend
import numpy as np  # noqa: E402
from report import outcome  # noqa: E402

SIDES = (0.0, 120.0, 240.0)  # degrees about the support's normal
BLUE, ORANGE = np.array([0.2, 0.45, 0.9]), np.array([0.95, 0.55, 0.1])


def read_part(path):
    """Points (n, 3), normals (n, 3), colours (n, 3) in [0, 1] of what benchmark_alignment --parts wrote."""
    with open(path) as text:
        rows = text.read().split("end_header\n")[1].split()
    values = np.array(rows, float).reshape(-1, 9)
    return values[:, :3], values[:, 3:6], values[:, 6:9] / 255


def draw(axis, points, normals, colours, degrees):
    """Points that face a viewer who looks at them at an angle from above, the far ones first."""
    turn, tilt = np.radians(degrees), np.radians(25)
    about = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    lean = np.array([[1, 0, 0], [0, np.sin(tilt), -np.cos(tilt)], [0, np.cos(tilt), np.sin(tilt)]])
    view = lean @ about
    p, n = points @ view.T, normals @ view.T
    order = np.argsort(p[:, 2])
    order = order[n[order, 2] > -0.2]
    light = np.clip(0.55 + 0.45 * n[order, 2], 0, 1)[:, None]
    axis.scatter(p[order, 0], p[order, 1], c=colours[order] * light, s=2, linewidths=0)
    axis.set_aspect("equal")
    axis.axis("off")


def upright(normals):
    """Rotation that puts the mean normal of a part, which no camera saw from below, up."""
    up = normals.mean(0)
    up /= max(np.linalg.norm(up), 1e-9)
    side = np.cross(up, [1, 0, 0] if abs(up[0]) < 0.9 else [0, 1, 0])
    side /= np.linalg.norm(side)
    return np.stack([side, np.cross(up, side), up])


def picture(pair, parts_folder, path):
    """First candidate and the true pose, in the colours of the parts and in two colours."""
    a, b = (read_part(os.path.join(parts_folder, pair[k].replace("/", "_") + ".ply")) for k in "ab")
    rows = [("found", c["a_from_b"]) for c in pair["candidates"][:1]] + [("true", pair["true_a_from_b"])]
    figure, axes = plt.subplots(len(rows), 2 * len(SIDES), figsize=(4 * len(SIDES), 2.6 * len(rows)), squeeze=False)
    turn = upright(a[1])
    for line, (label, pose) in zip(axes, rows):
        pose = np.array(pose)
        points = np.concatenate([a[0], b[0] @ pose[:3, :3].T + pose[:3, 3]]) @ turn.T
        normals = np.concatenate([a[1], b[1] @ pose[:3, :3].T]) @ turn.T
        points -= (points.min(0) + points.max(0)) / 2
        two = np.concatenate([np.tile(BLUE, (len(a[0]), 1)), np.tile(ORANGE, (len(b[0]), 1))])
        for k, degrees in enumerate(SIDES):
            draw(line[2 * k], points, normals, np.concatenate([a[2], b[2]]), degrees)
            draw(line[2 * k + 1], points, normals, two, degrees)
        line[0].set_title(label, fontsize=8, loc="left")
    figure.suptitle(f"{pair['a']}, {pair['b']}: {outcome(pair)}. {pair['reason'][:110]}", fontsize=8)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def pictures(report, parts_folder, out):
    """One picture for every pair of one object that is wrong or refused; returns their paths."""
    os.makedirs(out, exist_ok=True)
    paths = []
    for pair in report["pairs"]:
        if pair["same_object"] and outcome(pair) != "right":
            name = f"{outcome(pair)}_{pair['a']}_{pair['b']}.png".replace("/", "_")
            paths.append(os.path.join(out, name))
            picture(pair, parts_folder, paths[-1])
    return paths

#!/usr/bin/python3
"""How flat the faces of a carton's model are: RMS distance to a plane, and to a surface of second order, which takes the
carton's bulge out. The outer 5 mm of each face, where it folds, do not count."""
import argparse
import sys

import numpy as np

MAX_TURN_COSINE = 0.9  # of a triangle's normal from its face's
FOLD_M = 0.005
MAX_OFF_M = 0.012


def carton_axes(normals, areas):
    """The three directions that the triangles face, right angles between them."""
    axes = np.linalg.eigh((normals * areas[:, None]).T @ normals)[1]
    for _ in range(20):
        cosines = normals @ axes
        nearest = np.argmax(np.abs(cosines), 1)
        facing = np.max(np.abs(cosines), 1) > 0.95
        sums = np.zeros((3, 3))
        for k in range(3):
            own = facing & (nearest == k)
            sums[:, k] = (normals[own] * (np.sign(cosines[own, k]) * areas[own])[:, None]).sum(0)
        u, _, vt = np.linalg.svd(sums)
        axes = u @ vt
    return axes


def rms_mm(columns, heights, weights):
    root = np.sqrt(weights)
    matrix = np.stack(columns, 1)
    solution = np.linalg.lstsq(matrix * root[:, None], heights * root, rcond=None)[0]
    return 1e3 * np.sqrt(np.average((heights - matrix @ solution) ** 2, weights=weights))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh")
    parser.add_argument("--eval", required=True, help="folder of the evaluation kit, which reads meshes")
    arguments = parser.parse_args()
    sys.path.insert(0, arguments.eval)
    from evalkit.mesh import load_mesh  # pylint: disable=import-error,import-outside-toplevel

    mesh = load_mesh(arguments.mesh)
    normals, areas = mesh.face_normals_and_areas()
    axes = carton_axes(normals, areas)
    centres, normals = mesh.vertices[mesh.faces].mean(1) @ axes, normals @ axes
    print("| face mm | RMS to a plane mm | to a surface of second order mm |\n| --- | --- | --- |")
    for axis in range(3):
        for sign in (1, -1):
            own = sign * normals[:, axis] > MAX_TURN_COSINE
            if own.sum() < 50:
                continue  # the face that it stands on
            own &= np.abs(centres[:, axis] - np.median(centres[own, axis])) < MAX_OFF_M
            along = np.delete(centres, axis, 1)
            low, high = along[own].min(0) + FOLD_M, along[own].max(0) - FOLD_M
            own &= np.all((along > low) & (along < high), 1)
            x, y = ((along[own] - along[own].mean(0)) / 0.1).T
            plane = [np.ones_like(x), x, y]
            print("| %.0f x %.0f | %.2f | %.2f |" % (
                *(1e3 * (high - low + 2 * FOLD_M)), rms_mm(plane, centres[own, axis], areas[own]),
                rms_mm(plane + [x * x, x * y, y * y], centres[own, axis], areas[own])))


if __name__ == "__main__":
    main()

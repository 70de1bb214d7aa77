#!/usr/bin/python3
"""Writes procedural household things, each a folder as objects/README.md describes.

Kinds, in equal shares: carton, rounded_box, can, bottle (and jars), vessel (mugs, cups, bowls), tool. Object k depends
only on the seed, on k and on the kinds asked for; the same seed gives the same bytes. Use them in a suite as
`objects: {folder: OUT, seed: ..., tables: [...]}`.
"""

import argparse
import os
import time

import cv2
import numpy as np

from evalkit.mesh import load_mesh
from evalkit.procedural import KINDS, write_object
from evalkit.raster import linear_to_srgb8
from evalkit.scene import Camera, Scene


def picture(mesh_path, size=320):
    """Two views (BGR, side by side) of an object that stands upright, from opposite sides."""
    reach = np.ptp(load_mesh(mesh_path).vertices, axis=0).max()
    scene = Scene({"objects": [{"mesh": os.path.abspath(mesh_path), "T_world_object": np.eye(4).tolist()}],
                   "duration": 20.0, "background": {"walls": 0}, "table": {"texture": "plain", "radius": 0.4},
                   "motion": {"mode": "turntable", "sweep_deg": 400, "radius": 0.8, "elevation_deg": 25,
                              "azimuth_deg": -60}})
    focal = 0.6 * size * 0.8 / reach
    camera = Camera(scene, (focal, focal, size / 2 - 0.5, size / 2 - 0.5), size, size)
    return np.hstack([linear_to_srgb8(camera.linear_colour(t))[:, :, ::-1] for t in (0.0, 10.0)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="folder to write the objects' folders into")
    parser.add_argument("--count", type=int, default=24, help="number of objects, at most 10000")
    parser.add_argument("--first", type=int, default=0, help="number of the first object")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--sheet", help="also draw all objects, two views each, into this PNG")
    arguments = parser.parse_args()
    if arguments.seed < 0 or arguments.first < 0 or arguments.first + arguments.count > 10000:
        parser.error("seeds and numbers are not negative, numbers below 10000")
    start, tiles = time.time(), []
    for number in range(arguments.first, arguments.first + arguments.count):
        made = write_object(arguments.out, arguments.seed, number, arguments.kinds)
        print(f"{made['name']}: {made['variant']}, {made['print']}", flush=True)
        if arguments.sheet:
            tiles.append(picture(os.path.join(arguments.out, made["name"], "textured.obj")))
            cv2.putText(tiles[-1], f"{made['name']} {made['variant']} {made['print']}", (5, 14),
                        cv2.FONT_HERSHEY_SIMPLEX, 0.42, (0, 0, 0), 1, cv2.LINE_AA)
    print(f"{arguments.count} objects, {(time.time() - start) / max(arguments.count, 1):.1f} s each")
    if tiles:
        tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % 4)
        cv2.imwrite(arguments.sheet, np.vstack([np.hstack(tiles[k:k + 4]) for k in range(0, len(tiles), 4)]))


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Cuts the first frames of a TUM-style recording into a small one: JPEG colour, depth only up to a range."""

import argparse
import os
import shutil

import cv2


def read_list(path):
    """Rows of words of a TUM list, without comments."""
    with open(path) as lines:
        return [line.split() for line in lines if line.strip() and not line.startswith("#")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--frames", type=int, required=True)
    parser.add_argument("--max-depth", type=float, default=1.5, help="m; farther depth is left out (smaller files)")
    parser.add_argument("--jpeg-quality", type=int, default=85)
    arguments = parser.parse_args()

    camera_path = os.path.join(arguments.source, "camera.yaml")
    with open(camera_path) as camera:
        unit = next(float(line.split()[1]) for line in camera if line.startswith("depth_scale:"))
    pairs = read_list(os.path.join(arguments.source, "associations.txt"))[: arguments.frames]
    for folder in ("rgb", "depth"):
        os.makedirs(os.path.join(arguments.target, folder))
    shutil.copy(camera_path, arguments.target)

    lists = {"rgb.txt": ["# timestamp filename"], "depth.txt": ["# timestamp filename"],
             "associations.txt": ["# t_rgb rgb t_depth depth"]}
    for colour_stamp, colour, depth_stamp, depth in pairs:
        colour_out = f"rgb/{colour_stamp}.jpg"
        image = cv2.imread(os.path.join(arguments.source, colour), cv2.IMREAD_COLOR)
        cv2.imwrite(os.path.join(arguments.target, colour_out), image,
                    [cv2.IMWRITE_JPEG_QUALITY, arguments.jpeg_quality])
        depth_out = f"depth/{depth_stamp}.png"
        image = cv2.imread(os.path.join(arguments.source, depth), cv2.IMREAD_UNCHANGED)
        image[image > arguments.max_depth / unit] = 0
        cv2.imwrite(os.path.join(arguments.target, depth_out), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        lists["rgb.txt"].append(f"{colour_stamp} {colour_out}")
        lists["depth.txt"].append(f"{depth_stamp} {depth_out}")
        lists["associations.txt"].append(f"{colour_stamp} {colour_out} {depth_stamp} {depth_out}")
    for name, rows in lists.items():
        with open(os.path.join(arguments.target, name), "w") as out:
            out.write("\n".join(rows) + "\n")

    truth = os.path.join(arguments.source, "groundtruth.txt")
    if os.path.exists(truth):
        last = float(pairs[-1][0])
        with open(truth) as rows, open(os.path.join(arguments.target, "groundtruth.txt"), "w") as out:
            out.writelines(row for row in rows if row.startswith("#") or float(row.split()[0]) <= last + 1e-6)


if __name__ == "__main__":
    main()

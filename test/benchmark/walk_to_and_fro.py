#!/usr/bin/env python3
"""Makes a long recording of a short one: its frames there and back until the time is up.

Tracking it shows whether error and memory grow with time: benchmark_tracking prints the error of each minute. Every
frame keeps its true pose; stamps go on at the mean rate of the recording. Images are links, so nothing is copied.
"""

import argparse
import os
import sys


def read_list(path):
    with open(path, encoding="utf-8") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]


def nearest(rows, stamp_s):
    row = min(rows, key=lambda candidate: abs(float(candidate[0]) - stamp_s))
    return row if abs(float(row[0]) - stamp_s) < 0.02 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", help="TUM-style folder with rgb.txt, depth.txt, camera.yaml, groundtruth.txt")
    parser.add_argument("out", help="folder to make; it must not exist")
    parser.add_argument("--minutes", type=float, default=10)
    arguments = parser.parse_args()
    if os.path.exists(arguments.out):
        sys.exit("'%s' exists: remove it or give another folder" % arguments.out)
    lists = {name: read_list(os.path.join(arguments.recording, name))
             for name in ("rgb.txt", "depth.txt", "groundtruth.txt")}
    frames = []
    for stamp, path in lists["rgb.txt"]:
        rows = [nearest(lists[name], float(stamp)) for name in ("depth.txt", "groundtruth.txt")]
        if None not in rows:
            frames.append((path, rows[0][1], rows[1][1:]))
    if len(frames) < 2:
        sys.exit("'%s' has fewer than two frames with depth and true pose" % arguments.recording)
    first, last = (float(lists["rgb.txt"][i][0]) for i in (0, -1))
    interval_s = (last - first) / (len(lists["rgb.txt"]) - 1)

    os.makedirs(arguments.out)
    for entry in ("rgb", "depth", "camera.yaml"):
        os.symlink(os.path.abspath(os.path.join(arguments.recording, entry)), os.path.join(arguments.out, entry))
    there_and_back = frames + frames[-2:0:-1]
    with open(os.path.join(arguments.out, "rgb.txt"), "w", encoding="utf-8") as rgb, \
            open(os.path.join(arguments.out, "depth.txt"), "w", encoding="utf-8") as depth, \
            open(os.path.join(arguments.out, "groundtruth.txt"), "w", encoding="utf-8") as truth:
        for i in range(int(round(60 * arguments.minutes / interval_s))):
            color_path, depth_path, pose = there_and_back[i % len(there_and_back)]
            stamp = "%.6f" % (first + i * interval_s)
            rgb.write("%s %s\n" % (stamp, color_path))
            depth.write("%s %s\n" % (stamp, depth_path))
            truth.write("%s %s\n" % (stamp, " ".join(pose)))


if __name__ == "__main__":
    main()

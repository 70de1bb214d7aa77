#!/usr/bin/python3
"""Makes modelling sessions of many objects, for fitting and judging the alignment of sessions.

Each object is recorded two or three times, each time at rest in another pose, on another table, in other light, by one
sensor drawn for the object: a Kinect, active stereo or time of flight. With --repeat a share of the objects is also
recorded once more in a pose of before, as somebody does who did not turn the object over. Object k of a folder (sorted
by path) depends on (seed, k) only. Finished sequences are kept when run again.

Output: OUT/<object>/session_1 .. as simulate.py writes them, each with scene.yaml, its description.
"""

import argparse
import json
import multiprocessing
import os
import re
import time

import numpy as np
import yaml

SENSORS = {
    "kinect": {},
    "stereo": {"image": {"width": 848, "height": 480, "focal_px": 612}, "depth": {"model": "stereo"}},
    "tof": {"image": {"width": 1280, "height": 720, "focal_px": 610}, "depth": {"model": "tof"}},
}
TABLES = ["papers", "wood", "cloth", "plain"]
TABLE_SHARES = [0.45, 0.25, 0.2, 0.1]


def describe_object(path, number, arguments):
    """[(name, scene description)] of the sessions of one object."""
    from evalkit.mesh import distinct_resting_poses, load_mesh
    from evalkit.scene import object_metadata, object_name

    rng = np.random.default_rng([arguments.seed, number])
    mesh, name = load_mesh(path), object_name(path)
    poses = len(distinct_resting_poses(mesh, 8))
    sensor = str(rng.choice(list(SENSORS), p=arguments.sensors))
    count = 3 if rng.random() < arguments.third else 2
    resting = [int(i) for i in rng.permutation(poses)[:count]]
    if len(resting) < 2:
        print(f"{name}: rests in one pose only, left out", flush=True)
        return []
    if rng.random() < arguments.repeat:
        resting.append(resting[int(rng.integers(len(resting)))])
    size = float(mesh.diameter())
    distortion = float(rng.uniform(0.0003, 0.0012))
    sequences = []
    for k, pose in enumerate(resting):
        near = max(0.45, 0.36 + 0.7 * size) + float(rng.uniform(0, 0.1))
        low, high = float(rng.uniform(14, 26)), float(rng.uniform(46, 64))
        settings = json.loads(json.dumps(SENSORS[sensor]))
        depth = settings.setdefault("depth", {"model": "kinect"})
        if sensor == "kinect":
            depth["distortion"] = distortion
        sequences.append((f"{name}/session_{k + 1}", {
            "seed": int(rng.integers(2**31)), "duration": arguments.duration, "fps": arguments.fps,
            "table": {"texture": str(rng.choice(TABLES, p=TABLE_SHARES))},
            "light": {"key": float(rng.uniform(1.1, 1.9)), "fill": float(rng.uniform(0.4, 0.9)),
                      "ambient": float(rng.uniform(0.3, 0.55))},
            "objects": [{"mesh": os.path.abspath(path), "resting": pose, "yaw_deg": float(rng.uniform(0, 360)),
                         **({} if "id" in object_metadata(path) else {"id": 1001 + number})}],
            "motion": {"mode": "handheld", "sweep_deg": arguments.sweep_deg * float(rng.uniform(0.95, 1.1)),
                       "radius": [near, near + float(rng.uniform(0.1, 0.3))], "elevation_deg": [low, high]},
            **settings, "output": {"colour_format": "jpg", "mask_every": 0}}))
    return sequences


def run(task):
    """Renders one sequence; returns (name, frames, seconds)."""
    name, description, out = task
    import cv2
    from evalkit.record import record

    cv2.setNumThreads(1)
    start = time.time()
    count = record(description, ".", out)
    with open(os.path.join(out, "scene.yaml"), "w") as f:
        yaml.safe_dump(description, f, sort_keys=False)
    return name, count, time.time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("objects", help="folder of object folders with a textured.obj each")
    parser.add_argument("out", help="output folder")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--sensors", type=float, nargs=3, default=[0.65, 0.25, 0.1], metavar="SHARE",
                        help="shares of objects recorded by Kinect, stereo, time of flight")
    parser.add_argument("--third", type=float, default=0.3, help="share of objects with a third session")
    parser.add_argument("--repeat", type=float, default=0.0, help="share recorded once more in a pose of before")
    parser.add_argument("--duration", type=float, default=10.0, help="s")
    parser.add_argument("--fps", type=float, default=10.0)
    parser.add_argument("--sweep-deg", type=float, default=390.0, help="walked round the object")
    parser.add_argument("--limit", type=int, help="the first so many objects only")
    parser.add_argument("--skip", type=int, default=0, help="leave out the first so many objects")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    os.environ["NUMBA_NUM_THREADS"] = str(max(1, (os.cpu_count() or 1) // arguments.jobs))
    meshes = sorted(os.path.join(at, name) for at, _, names in os.walk(arguments.objects, followlinks=True) for name in names
                    if name.lower().endswith(".obj"))
    tasks = []
    for number, path in enumerate(meshes[:arguments.limit]):
        if number < arguments.skip:
            continue
        for name, description in describe_object(path, number, arguments):
            out = os.path.join(arguments.out, name)
            if not os.path.exists(os.path.join(out, "scene.yaml")):
                tasks.append((name, description, out))
    # By the number in the name, so that what is done early is of every kind.
    tasks.sort(key=lambda task: (re.findall(r"\d+", task[0].split("/")[0])[-1:], task[0]))
    start, total = time.time(), 0
    with multiprocessing.get_context("spawn").Pool(arguments.jobs) as pool:
        for name, count, seconds in pool.imap_unordered(run, tasks):
            total += count
            print(f"{name}: {count} frames in {seconds:.0f} s", flush=True)
    print(f"{len(tasks)} sequences, {total} frames, {total / max(time.time() - start, 1e-9):.1f} frames/s")


if __name__ == "__main__":
    main()

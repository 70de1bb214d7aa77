"""TUM-style recordings and trajectories for the scripts here."""

import os

import cv2
import numpy as np
import yaml


def open_recording(folder):
    """The camera.yaml, and frames(skip, every): an iterator over (stamp, colour, depth), rectified."""
    with open(os.path.join(folder, "camera.yaml")) as text:
        camera = yaml.safe_load(text)
    with open(os.path.join(folder, "associations.txt")) as text:
        rows = [line.split() for line in text if line.strip() and not line.startswith("#")]
    k = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
    maps = None
    if np.any(camera["distortion"]):
        maps = cv2.initUndistortRectifyMap(k, np.array(camera["distortion"]), None, k,
                                           (camera["width"], camera["height"]), cv2.CV_32FC1)

    def frames(skip=0, every=1):
        for stamp, colour_path, _, depth_path in rows[skip::every]:
            colour = cv2.imread(os.path.join(folder, colour_path))
            depth = cv2.imread(os.path.join(folder, depth_path), cv2.IMREAD_UNCHANGED)
            if maps is not None:
                colour = cv2.remap(colour, *maps, cv2.INTER_LINEAR)
                depth = cv2.remap(depth, *maps, cv2.INTER_NEAREST)
            yield float(stamp), colour, depth

    return camera, frames


def quaternion(r):
    """(x, y, z, w) of a 3x3 rotation."""
    vector, _ = cv2.Rodrigues(r)
    angle = np.linalg.norm(vector)
    axis = vector.ravel() / angle if angle > 0 else np.zeros(3)
    return [*(np.sin(angle / 2) * axis), np.cos(angle / 2)]


def write_trajectory(path, stamps, poses):
    with open(path, "w") as text:
        for stamp, pose in zip(stamps, poses):
            values = [*pose[:3, 3], *quaternion(pose[:3, :3])]
            text.write(f"{stamp:.6f} " + " ".join(f"{value:.9f}" for value in values) + "\n")

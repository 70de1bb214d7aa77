"""Poses of messages as matrices, and boxes of detections."""
import itertools

import numpy as np
from geometry_msgs.msg import Pose

# Of a box whose corners are in the order of corners(): counter-clockwise seen from outside.
BOX_TRIANGLES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                 (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def matrix(pose):
    """4x4 of a geometry_msgs/Pose."""
    x, y, z, w = pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), pose.position.x],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), pose.position.y],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), pose.position.z],
        [0, 0, 0, 1]])


def quaternion(rotation):
    """x, y, z, w of a 3x3 rotation, w not negative."""
    # The eigenvector of the greatest eigenvalue (Bar-Itzhack, 2000): sound for any rotation.
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    symmetric = np.array([[xx - yy - zz, 0, 0, 0], [yx + xy, yy - xx - zz, 0, 0],
                          [zx + xz, zy + yz, zz - xx - yy, 0], [zy - yz, xz - zx, yx - xy, xx + yy + zz]])
    vector = np.linalg.eigh(symmetric)[1][:, -1]
    return vector if vector[3] >= 0 else -vector


def pose_message(target_from_source):
    """geometry_msgs/Pose of a 4x4."""
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = target_from_source[:3, 3]
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = quaternion(
        target_from_source[:3, :3])
    return pose


def camera_from_box(detection):
    """4x4 of the box of an object_modelling/Detection."""
    return matrix(detection.pose.pose) @ matrix(detection.model_from_box)


def corners(detection):
    """8 x 3, m, of the detection's box in the camera's frame; z changes first, then y, then x."""
    size = np.array([detection.size_m.x, detection.size_m.y, detection.size_m.z])
    signs = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
    pose = camera_from_box(detection)
    return (signs * size) @ pose[:3, :3].T + pose[:3, 3]

#!/usr/bin/python3
"""Open3D's TSDF of a simulated recording with known objects: every 6th frame, voxels of 2 mm, cut by the object's true
box, from given poses of the frames; scored by the kit. See README.md. Prints the scores as JSON.

The truth places and cuts the model; whoever has none would have to segment it first.
"""

import argparse
import json
import os
import subprocess
import sys
import time

import cv2
import numpy as np
import open3d as o3d
import yaml

import tum

ROOM_M = 0.005  # of the box round the object
ABOVE_TABLE_M = 0.002


def read_trajectory(path):
    """stamp -> 4x4 pose."""
    poses = {}
    for row in np.loadtxt(path):
        pose = np.eye(4)
        pose[:3, :3] = rotation(row[4:8])
        pose[:3, 3] = row[1:4]
        poses[round(row[0], 3)] = pose
    return poses


def rotation(xyzw):
    xyz, angle = np.asarray(xyzw[:3]), 2 * np.arctan2(np.linalg.norm(xyzw[:3]), xyzw[3])
    norm = np.linalg.norm(xyz)
    return cv2.Rodrigues(xyz / norm * angle)[0] if norm > 0 else np.eye(3)


def rigid(target, source):
    """T_target_source of least squares between positions (Umeyama without scale)."""
    a, b = target - target.mean(0), source - source.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    t = np.eye(4)
    t[:3, :3] = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    t[:3, 3] = target.mean(0) - t[:3, :3] @ source.mean(0)
    return t


def into_world(poses, truth):
    stamps = sorted(set(poses) & set(truth))
    t_world_session = rigid(np.array([truth[s][:3, 3] for s in stamps]), np.array([poses[s][:3, 3] for s in stamps]))
    return {s: t_world_session @ poses[s] for s in stamps}


def reconstruct(recording, t_world_camera, arguments):
    camera, frames = tum.open_recording(recording)
    intrinsics = o3d.camera.PinholeCameraIntrinsic(
        camera["width"], camera["height"], camera["fx"], camera["fy"], camera["cx"], camera["cy"])
    volume = o3d.pipelines.integration.ScalableTSDFVolume(
        voxel_length=arguments.voxel_m, sdf_trunc=4 * arguments.voxel_m,
        color_type=o3d.pipelines.integration.TSDFVolumeColorType.RGB8)
    for stamp, colour, depth in frames(0, arguments.every):
        pose = t_world_camera.get(round(stamp, 3))
        if pose is None:
            continue
        image = o3d.geometry.RGBDImage.create_from_color_and_depth(
            o3d.geometry.Image(np.ascontiguousarray(colour[:, :, ::-1])), o3d.geometry.Image(depth),
            1 / camera["depth_scale"], 2.0, False)
        volume.integrate(image, intrinsics, np.linalg.inv(pose))
    return volume.extract_triangle_mesh()


def true_object(recording, kit):
    """(path of the mesh, T_world_object, low and high corner of its box in the object's frame)."""
    with open(os.path.join(recording, "objects.yaml")) as text:
        entry = yaml.safe_load(text)["objects"][0]
    path = os.path.join(kit, "objects", os.path.basename(os.path.dirname(entry["mesh"])), "textured.obj")
    points = np.asarray(o3d.io.read_triangle_mesh(path).vertices)
    return path, np.array(entry["T_world_object"]), points.min(0), points.max(0)


def cut(mesh, t_world_object, low, high):
    points = np.asarray(mesh.vertices)
    t = np.linalg.inv(t_world_object)
    local = points @ t[:3, :3].T + t[:3, 3]
    outside = ((local < low - ROOM_M) | (local > high + ROOM_M)).any(1) | (points[:, 2] < ABOVE_TABLE_M)
    mesh.remove_vertices_by_mask(outside)
    return mesh


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", help="folder of the kit's simulator")
    parser.add_argument("--poses", help="TUM file of camera poses; without it the true ones")
    parser.add_argument("--eval", required=True, help="folder of the evaluation kit")
    parser.add_argument("--out", required=True, help="PLY to write")
    parser.add_argument("--every", type=int, default=6)
    parser.add_argument("--voxel-m", type=float, default=0.002)
    arguments = parser.parse_args()

    truth = read_trajectory(os.path.join(arguments.recording, "groundtruth.txt"))
    poses = into_world(read_trajectory(arguments.poses), truth) if arguments.poses else truth
    path, t_world_object, low, high = true_object(arguments.recording, arguments.eval)
    start = time.perf_counter()
    mesh = cut(reconstruct(arguments.recording, poses, arguments), t_world_object, low, high)
    seconds = time.perf_counter() - start
    o3d.io.write_triangle_mesh(arguments.out, mesh)
    scored = subprocess.run(
        [sys.executable, os.path.join(arguments.eval, "score_model.py"), arguments.out, path, "--session",
         arguments.recording], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, text=True)
    print(json.dumps({"recording": arguments.recording, "poses": arguments.poses or "truth", "seconds": seconds,
                      "score": json.loads(scored.stdout)}))


if __name__ == "__main__":
    main()

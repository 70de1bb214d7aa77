#!/usr/bin/python3
"""Open3D's hybrid RGB-D odometry on a recording, as its user would run it; see README.md.

Every frame is placed against the last keyframe. With --loop-closures the keyframes that see the same are matched by
the same odometry too, and their pose graph is optimised; frames keep their poses relative to their keyframes.
Prints the times as JSON.
"""

import argparse
import json
import time

import numpy as np
import open3d as o3d

import tum

MAX_STEP_M, MAX_STEP_DEG = 0.5, 30.0  # between two frames: more is a failure
MAX_FAILURES = 30  # in a row: then the present frame is the new keyframe, where the last pose was

odometry = o3d.pipelines.odometry
registration = o3d.pipelines.registration


def angle_deg(t):
    return np.degrees(np.arccos(np.clip((np.trace(t[:3, :3]) - 1) / 2, -1, 1)))


def within(t, metres, degrees):
    return np.linalg.norm(t[:3, 3]) <= metres and angle_deg(t) <= degrees


class Odometry:
    """Relative pose of two frames."""

    def __init__(self, camera):
        self.intrinsics = o3d.camera.PinholeCameraIntrinsic(
            camera["width"], camera["height"], camera["fx"], camera["fy"], camera["cx"], camera["cy"])
        self.jacobian = odometry.RGBDOdometryJacobianFromHybridTerm()
        self.option = odometry.OdometryOption()

    def __call__(self, source, target, guess):
        """(success, target_from_source, information)"""
        return odometry.compute_rgbd_odometry(source, target, self.intrinsics, guess, self.jacobian, self.option)


def as_rgbd(colour, depth, depth_scale):
    return o3d.geometry.RGBDImage.create_from_color_and_depth(
        o3d.geometry.Image(np.ascontiguousarray(colour[:, :, ::-1])), o3d.geometry.Image(depth), 1 / depth_scale, 4.0,
        True)


class Chain:
    """Poses of frames from those against the last keyframe; on failure the last pose is kept."""

    def __init__(self, odometry_of, arguments):
        self.odometry, self.arguments = odometry_of, arguments
        self.keyframes, self.edges = [], []  # images; information to the keyframe before
        self.graph = registration.PoseGraph()
        self.frames = []  # keyframe index and keyframe_from_camera
        self.step = np.eye(4)
        self.failures, self.lost = 0, 0

    def add(self, image):
        if not self.keyframes:
            self._add_keyframe(image, np.eye(4), None)
            self.frames.append((0, np.eye(4)))
            return
        index, last = self.frames[-1]
        guess = last @ self.step if self.arguments.start == "velocity" else last
        good, found, information = self.odometry(image, self.keyframes[-1], guess)
        step = np.linalg.inv(last) @ found
        good = good and within(step, MAX_STEP_M, MAX_STEP_DEG)
        self.step = step if good else np.eye(4)
        self.failures = 0 if good else self.failures + 1
        self.lost += not good
        pose = found if good else last
        moved = good and not within(pose, self.arguments.keyframe_m, self.arguments.keyframe_deg)
        if moved or self.failures >= MAX_FAILURES:
            self._add_keyframe(image, pose, information if good else np.eye(6))
            index, pose = len(self.keyframes) - 1, np.eye(4)
        self.frames.append((index, pose))

    def _add_keyframe(self, image, previous_from_this, information):
        previous = self.graph.nodes[-1].pose if self.keyframes else np.eye(4)
        self.graph.nodes.append(registration.PoseGraphNode(previous @ previous_from_this))
        self.keyframes.append(image)
        self.failures = 0
        if information is not None:
            k = len(self.keyframes) - 1
            self.graph.edges.append(
                registration.PoseGraphEdge(k, k - 1, previous_from_this, information, uncertain=False))

    def close_loops(self):
        """Matches all keyframes that see the same by their poses, and optimises; returns the number of closures."""
        count = 0
        for j in range(len(self.keyframes)):
            for i in range(j - 1):
                guess = np.linalg.inv(self.graph.nodes[i].pose) @ self.graph.nodes[j].pose
                if not within(guess, self.arguments.loop_m, self.arguments.loop_deg):
                    continue
                good, found, information = self.odometry(self.keyframes[j], self.keyframes[i], guess)
                if good and within(np.linalg.inv(guess) @ found, self.arguments.loop_m, self.arguments.loop_deg):
                    self.graph.edges.append(registration.PoseGraphEdge(j, i, found, information, uncertain=True))
                    count += 1
        option = registration.GlobalOptimizationOption(
            max_correspondence_distance=self.odometry.option.depth_diff_max, edge_prune_threshold=0.25,
            preference_loop_closure=1.0, reference_node=0)
        registration.global_optimization(self.graph, registration.GlobalOptimizationLevenbergMarquardt(),
                                         registration.GlobalOptimizationConvergenceCriteria(), option)
        return count

    def trajectory(self):
        return [self.graph.nodes[index].pose @ pose for index, pose in self.frames]


def statistics(values):
    return {"median": float(np.median(values)), "p95": float(np.percentile(values, 95)), "max": float(max(values))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", help="TUM-style folder")
    parser.add_argument("--out", required=True, help="trajectory to write, TUM format")
    parser.add_argument("--loop-closures", metavar="FILE", help="also close loops, and write the trajectory after it")
    parser.add_argument("--every", type=int, default=1, help="only every Nth frame")
    parser.add_argument("--skip", type=int, default=0, help="leave out the first N frames")
    parser.add_argument("--start", choices=("velocity", "last"), default="velocity",
                        help="where the search starts: constant velocity, or the last pose")
    parser.add_argument("--keyframe-m", type=float, default=0.05, help="motion to the next keyframe; 0: frame to frame")
    parser.add_argument("--keyframe-deg", type=float, default=5.0)
    parser.add_argument("--loop-m", type=float, default=0.3, help="keyframes closer than this are matched")
    parser.add_argument("--loop-deg", type=float, default=30.0)
    arguments = parser.parse_args()

    camera, frames = tum.open_recording(arguments.recording)
    chain = Chain(Odometry(camera), arguments)
    stamps, wall, cpu = [], [], []
    for stamp, colour, depth in frames(arguments.skip, arguments.every):
        image = as_rgbd(colour, depth, camera["depth_scale"])
        start, cpu_start = time.perf_counter(), time.process_time()
        chain.add(image)
        wall.append(1e3 * (time.perf_counter() - start))
        cpu.append(1e3 * (time.process_time() - cpu_start))
        stamps.append(stamp)
    tum.write_trajectory(arguments.out, stamps, chain.trajectory())
    result = {"method": "open3d_hybrid", "frames": len(stamps), "lost": chain.lost, "keyframes": len(chain.keyframes),
              "wall_ms": statistics(wall), "cpu_ms": statistics(cpu), "cpu_s": sum(cpu) / 1e3}
    if arguments.loop_closures:
        start, cpu_start = time.perf_counter(), time.process_time()
        result["loop_closures"] = chain.close_loops()
        result["loop_wall_s"] = time.perf_counter() - start
        result["loop_cpu_s"] = time.process_time() - cpu_start
        tum.write_trajectory(arguments.loop_closures, stamps, chain.trajectory())
    print(json.dumps(result))


if __name__ == "__main__":
    main()

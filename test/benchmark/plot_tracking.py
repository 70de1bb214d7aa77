#!/usr/bin/python3
"""Plots what benchmark_tracking --json wrote: trajectory against truth, error over time, time per stage.

Writes PREFIX_trajectory.png, PREFIX_error.png and PREFIX_time.png per recording, or with several recordings
PREFIX_<recording>_... . Needs python3-matplotlib, which nothing else here does.
"""

import argparse
import json
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of the backend
import numpy as np  # noqa: E402

LIVE, REFINED, TRUTH = "tab:blue", "tab:orange", "0.55"
STAGES = ["pyramid", "flow", "map", "dense", "recognition", "keyframe", "other"]


def name_of(recording):
    return "_".join(recording["recording"].rstrip("/").split("/")[-2:])


def series(poses, key):
    return np.array([pose[key] for pose in poses])


def with_gaps(times, *values, longest_s=0.2):
    """Breaks the lines where no frame was tracked."""
    gaps = np.flatnonzero(np.diff(times) > max(longest_s, 3 * np.median(np.diff(times)))) + 1
    return [np.insert(np.asarray(v, float), gaps, np.nan, axis=0) for v in (times, *values)]


def event_spans(recording, start):
    for event in (recording["live"] or {}).get("relocalisation", []):
        yield event["start"] - start, event["end"] - start, event["type"]


def plot_trajectory(recording, path):
    poses = recording["pose_series"]
    times, truth, live = with_gaps(series(poses, "stamp"), series(poses, "truth"), series(poses, "position"))
    figure, axes = plt.subplots(figsize=(6, 5.5), layout="constrained")
    axes.plot(truth[:, 0], truth[:, 1], color=TRUTH, linewidth=3, label="truth")
    axes.plot(live[:, 0], live[:, 1], color=LIVE, linewidth=1,
              label=f"live, ATE {recording['live']['ate_mm']['rmse']:.2f} mm")
    refined = recording["refined_pose_series"]
    if refined:
        times, refined_xyz = with_gaps(series(refined, "stamp"), series(refined, "position"))
        ate_mm = recording["refinement"]["score"]["ate_mm"]["rmse"]
        axes.plot(refined_xyz[:, 0], refined_xyz[:, 1], color=REFINED, linewidth=1,
                  label=f"refined, ATE {ate_mm:.2f} mm")
    axes.plot(*truth[0, :2], "o", color="black", markersize=4, label="start")
    axes.set(xlabel="x [m]", ylabel="y [m]", title=f"{name_of(recording)}, from above", aspect="equal")
    axes.grid(alpha=0.3)
    axes.legend(loc="best", fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def plot_error(recording, path):
    start = recording["frame_series"][0]["stamp"]
    figure, axes = plt.subplots(2, 1, figsize=(8, 4.5), sharex=True, layout="constrained")
    for poses, colour, label in ((recording["pose_series"], LIVE, "live"),
                                 (recording["refined_pose_series"], REFINED, "refined")):
        if not poses:
            continue
        times, position_mm, rotation_deg = with_gaps(
            series(poses, "stamp") - start, series(poses, "position_mm"), series(poses, "rotation_deg"))
        axes[0].plot(times, position_mm, color=colour, linewidth=1, label=label)
        axes[1].plot(times, rotation_deg, color=colour, linewidth=1, label=label)
    for axis in axes:
        for k, (begin, end, kind) in enumerate(event_spans(recording, start)):
            axis.axvspan(begin, end, color="0.9", label="scene out of sight" if k == 0 else None)
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
    axes[0].set(ylabel="position [mm]", title=f"{name_of(recording)}: error after alignment")
    axes[1].set(ylabel="rotation [deg]", xlabel="time [s]")
    axes[0].legend(loc="best", fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def plot_time(recording, path):
    frames = recording["frame_series"]
    start = frames[0]["stamp"]
    times = series(frames, "stamp") - start
    stages = {stage: np.array([frame["stages_ms"][stage] for frame in frames]) for stage in STAGES}
    figure, (over_time, boxes) = plt.subplots(1, 2, figsize=(10, 4), width_ratios=[2, 1], layout="constrained")
    over_time.stackplot(times, *stages.values(), labels=STAGES, linewidth=0)
    wall = recording["wall_ms"]
    total = sum(stages.values())
    over_time.set(xlabel="time [s]", ylabel="wall time [ms]", ylim=(0, 1.6 * np.percentile(total, 95)),
                  title=f"{name_of(recording)}: median {wall['median']:.1f} ms, p95 {wall['p95']:.1f} ms")
    over_time.legend(loc="upper right", fontsize=7, ncol=4)
    used = [(stage, values[values > 0]) for stage, values in stages.items() if np.any(values > 0)]
    boxes.boxplot([values for _, values in used], labels=[f"{stage} ({len(values)})" for stage, values in used],
                  whis=(5, 95), showfliers=False)
    boxes.set(ylabel="wall time [ms]", yscale="log", title="frames that ran it; quartiles, 5 and 95 %")
    boxes.title.set_fontsize(8)
    boxes.tick_params(axis="x", labelsize=7, rotation=45)
    boxes.grid(alpha=0.3, axis="y")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("json", help="file written by benchmark_tracking --json")
    parser.add_argument("prefix", help="of the images, such as docs/images/tracking")
    parser.add_argument("--only", help="recordings whose path contains this")
    arguments = parser.parse_args()
    with open(arguments.json) as text:
        recordings = json.load(text)["recordings"]
    if arguments.only:
        recordings = [recording for recording in recordings if arguments.only in recording["recording"]]
    if not recordings:
        parser.error("no such recording")
    os.makedirs(os.path.dirname(arguments.prefix) or ".", exist_ok=True)
    for recording in recordings:
        prefix = arguments.prefix if len(recordings) == 1 else f"{arguments.prefix}_{name_of(recording)}"
        if recording["pose_series"]:
            plot_trajectory(recording, prefix + "_trajectory.png")
            plot_error(recording, prefix + "_error.png")
        plot_time(recording, prefix + "_time.png")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Plots what benchmark_session --json wrote: seconds of each stage, and of all, by the length of the session."""

import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of the backend


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", help="written by benchmark_session --json")
    parser.add_argument("png", help="written")
    arguments = parser.parse_args()
    with open(arguments.json) as text:
        rows = json.load(text)
    counts = [row["keyframes"] for row in rows]
    stages = sorted(rows[-1]["stage_s"], key=rows[-1]["stage_s"].get, reverse=True)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    for stage in stages:
        axes[0].plot(counts, [row["stage_s"][stage] for row in rows], "o-", markersize=3, label=stage)
    total_s = [sum(row["stage_s"].values()) for row in rows]
    axes[1].plot(counts, [1000 * total / count for total, count in zip(total_s, counts)], "o-", color="black",
                 label="all stages")
    axes[0].set(ylabel="time [s]", title="stage by stage")
    axes[1].set(ylabel="time per keyframe [ms]", title="level if time grows linearly")
    for axis in axes:
        axis.set(xlabel="keyframes")
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
        axis.legend(loc="best", fontsize=8)
    figure.savefig(arguments.png, dpi=110)


if __name__ == "__main__":
    main()

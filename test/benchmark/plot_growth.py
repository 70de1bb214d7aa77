#!/usr/bin/python3
"""Plots what benchmark_alignment --growth --json wrote: time to align by the number of sessions."""

import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of the backend


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", help="written by benchmark_alignment --growth --json")
    parser.add_argument("png", help="written")
    arguments = parser.parse_args()
    with open(arguments.json) as text:
        rows = json.load(text)
    counts = [row["sessions"] for row in rows]
    figure, axis = plt.subplots(figsize=(5.5, 4), layout="constrained")
    axis.plot(counts, [row["all_s"] for row in rows], "o-", markersize=4, label="all pairs")
    axis.plot(counts, [row["one_more_s"] for row in rows], "s-", markersize=4, label="one more, the others known")
    axis.set(xlabel="sessions", ylabel="time [s]", title="alignment, two cores")
    axis.set_ylim(bottom=0)
    axis.grid(alpha=0.3)
    axis.legend()
    figure.savefig(arguments.png, dpi=110)


if __name__ == "__main__":
    main()

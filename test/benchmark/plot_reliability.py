#!/usr/bin/python3
"""Plots how often alignments are right against the probability that they are given, from files that benchmark_alignment
--json wrote: pairs of one object, and of two."""

import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of the backend
import numpy as np  # noqa: E402

BINS = np.array([0, 0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 1.0001])


def first_candidates(path):
    """Probability, right or not, accepted or not, of the best candidate of every pair that has one."""
    with open(path) as text:
        pairs = json.load(text)["pairs"]
    best = [(pair, pair["candidates"][0]) for pair in pairs if pair["candidates"]]
    return (np.array([candidate["probability"] for _, candidate in best]),
            np.array([pair["same_object"] and candidate["right"] for pair, candidate in best]),
            np.array([pair["accepted"] for pair, _ in best]))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("png", help="written")
    parser.add_argument("json", nargs="+", help="LABEL=FILE, written by benchmark_alignment --json")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    axes[0].plot([0, 1], [0, 1], color="gray", linewidth=1)
    for argument in arguments.json:
        label, path = argument.split("=", 1)
        probability, right, accepted = first_candidates(path)
        which = np.digitize(probability, BINS) - 1
        used = [k for k in range(len(BINS) - 1) if (which == k).any()]
        mean = [probability[which == k].mean() for k in used]
        share = [right[which == k].mean() for k in used]
        sigma = [np.sqrt(max(s * (1 - s), 0.01) / (which == k).sum()) for k, s in zip(used, share)]
        axes[0].errorbar(mean, share, yerr=sigma, fmt="o-", markersize=4, capsize=2, label=label)
        axes[1].step(BINS[:-1], np.histogram(probability, BINS)[0], where="post", label=label)
        wrong = accepted & ~right
        print("%s: %d pairs, Brier score %.3f, accepted %d, of them wrong %d" % (
            label, len(probability), np.mean((probability - right) ** 2), accepted.sum(), wrong.sum()))
        for k, m, s in zip(used, mean, share):
            print("  probability %.2f to %.2f: %4d pairs, mean %.2f, right %.2f" % (
                BINS[k], min(1, BINS[k + 1]), (which == k).sum(), m, s))
    axes[0].set(xlabel="probability of the best candidate", ylabel="share that is right", title="reliability")
    axes[1].set(xlabel="probability", ylabel="pairs", title="how many")
    for axis in axes:
        axis.grid(alpha=0.3)
        axis.legend(loc="best", fontsize=8)
    figure.savefig(arguments.png, dpi=110)


if __name__ == "__main__":
    main()

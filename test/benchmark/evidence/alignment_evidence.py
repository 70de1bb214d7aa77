#!/usr/bin/python3
"""Fits the weights by which alignment judges poses, calibrates them on other objects, and reports on yet others.

Reads what `benchmark_alignment --json` wrote. `fit` writes the weights as a C++ header; `report` prints tables of
what the built program decided. Poses are judged by the true meshes (judge.py).
"""

import argparse
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "evaluation_kit"))

from difference import NAMES as DIFFERENCES, difference_header, examples, fit_difference, loss  # noqa: E402, after the path of the kit
from judge import Judge  # noqa: E402
from logistic import Choice, calibrate, fit, probabilities  # noqa: E402
from pictures import pictures  # noqa: E402
from report import failures_table, same_pose, tables_of, well_recorded  # noqa: E402

PRIOR_RAD = (0.26, 0.52)  # as in pair_evidence.cpp
SAME_POSE_PROBABILITY = 1e-9  # in the fit: no such pose is taken unasked, so that it must not bend the weights
FEATURES = ("overlap", "space", "through", "fit", "contact", "texture", "color", "edges", "features")  # as in the header
FOR_A_POSE = ("overlap", "space", "through", "fit", "contact", "color", "edges", "features")


def read(paths):
    """Judged reports. What was judged is kept beside each file, for judging takes minutes."""
    judge, reports = Judge(), []
    for path in paths:
        judged = path + ".judged"
        if not os.path.exists(judged) or os.path.getmtime(judged) < os.path.getmtime(path):
            with open(path) as text:
                report = judge.judge(json.load(text))
            with open(judged, "w") as text:
                json.dump(report, text)
        with open(judged) as text:
            reports.append(json.load(text))
    return reports


def turn_prior(turn_rad):
    if turn_rad < 0:
        return 0.0
    low, high = PRIOR_RAD
    not_turned = np.clip((high - turn_rad) / (high - low), 0, 1)
    return float(not_turned * np.log(SAME_POSE_PROBABILITY / (1 - SAME_POSE_PROBABILITY)))


def choices_of(reports, names, cross_weight):
    """A choice for every pair that has poses. Together, pairs of two objects weigh `cross_weight` of those of one.
    Badly tracked recordings have the shape of another object, and are left out."""
    pairs = []
    for report in reports:
        sessions = {session["id"]: session for session in report["sessions"]}
        pairs += [p for p in report["pairs"] if p["candidates"] and not same_pose(p)
                  and not (p["same_object"] and not well_recorded(p, sessions))]
    same, cross = sum(p["same_object"] for p in pairs), sum(not p["same_object"] for p in pairs)
    choices = []
    for pair in pairs:
        features = np.array([[c["features"][n] for n in names] for c in pair["candidates"]])
        prior = np.array([turn_prior(c["turn_rad"]) for c in pair["candidates"]])
        weight = 1.0 if pair["same_object"] else cross_weight * same / max(cross, 1)
        choices.append(Choice(features, [c["right"] for c in pair["candidates"]], prior, weight))
    return choices


def header(names, parameters, errors, arguments, counts):
    lines = ["#pragma once", "",
             "// Written by test/benchmark/evidence/alignment_evidence.py fit; docs/alignment.md. Not to be edited by hand.",
             f"// Fitted on {counts[0]} pairs, calibrated on {counts[1]}.", "namespace object_modelling::alignment", "{",
             f"constexpr double WEIGHT_BIAS = {parameters[-1]:.4f};  // +- {errors[-1]:.2f}",
             "constexpr double WEIGHTS[] = {"]
    lines += [f"  {w:.4f},  // {n}, +- {e:.2f}" for n, w, e in zip(names, parameters, errors)]
    return "\n".join(lines + ["};", "}  // namespace object_modelling::alignment", ""])


def summary(parameters, choices):
    """Accuracy of the first choice and Brier score of its probability."""
    first = [int(np.argmax(probabilities(parameters, c))) for c in choices]
    p = np.array([probabilities(parameters, c)[k] for c, k in zip(choices, first)])
    right = np.array([c.right[k] for c, k in zip(choices, first)])
    return f"{len(choices)} pairs, first right {right.sum()}, Brier {np.mean((p - right) ** 2):.4f}"


def run_fit(arguments):
    fitted, calibration = read(arguments.fit), read(arguments.calibrate)
    names = list(fitted[0]["pairs"][0]["candidates"][0]["features"])
    names.sort(key=FEATURES.index)
    choices = choices_of(fitted, names, arguments.cross_weight)
    others = choices_of(calibration, names, arguments.cross_weight)
    positive = [k for k, n in enumerate(names) if n in FOR_A_POSE]
    parameters, errors = fit(choices, arguments.strength, positive, [names.index("texture")])
    print("fit:        ", summary(parameters, choices))
    print("other, as is:", summary(parameters, others))
    parameters, scale, shift = calibrate(parameters, others)
    print(f"calibrated:  {summary(parameters, others)}; scale {scale:.2f}, bias {shift:.2f}")
    for name, weight, error in zip([*names, "bias"], parameters, scale * errors):
        print(f"  {name:12s} {weight:8.3f} +- {error:.3f}")
    if arguments.header:
        with open(arguments.header, "w") as text:
            text.write(header(names, parameters, scale * errors, arguments, (len(choices), len(others))))


def well_recorded_pairs(reports):
    for report in reports:
        sessions = {session["id"]: session for session in report["sessions"]}
        yield from (p for p in report["pairs"] if p["same_object"] and well_recorded(p, sessions))


def run_fit_difference(arguments):
    fitted = examples(well_recorded_pairs(read(arguments.fit)))
    others = examples(well_recorded_pairs(read(arguments.check)))
    parameters, errors = fit_difference(*fitted, arguments.strength)
    for name, (features, right, weights) in (("fit", fitted), ("other", others)):
        value = loss(parameters, features, right, weights, np.zeros(len(parameters)))[0] / weights.sum()
        print(f"{name}: {len(right)} rivals, of them right by weight {right @ weights / weights.sum():.3f}, mean loss {value:.3f}")
    for name, weight, error in zip([*DIFFERENCES, "bias"], parameters, errors):
        print(f"  {name:12s} {weight:8.3f} +- {error:.3f}")
    if arguments.header:
        with open(arguments.header, "w") as text:
            text.write(difference_header(parameters, errors, len(fitted[1])))


def run_report(arguments):
    for path, report in zip(arguments.json, read(arguments.json)):
        print(f"## {os.path.basename(path)}\n\n{tables_of(report)}")
        if arguments.failures and "objects" not in report:
            print("\n" + failures_table(report))


def run_pictures(arguments):
    for report in read(arguments.json):
        print("\n".join(pictures(report, arguments.parts, arguments.out)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    fitting = commands.add_parser("fit")
    fitting.add_argument("--fit", nargs="+", required=True, metavar="JSON")
    fitting.add_argument("--calibrate", nargs="+", required=True, metavar="JSON", help="of other objects")
    fitting.add_argument("--header", help="written: src/alignment/pair_weights.h")
    fitting.add_argument("--strength", type=float, default=2.0, help="of the penalty")
    fitting.add_argument("--cross-weight", type=float, default=0.5,
                         help="of all pairs of two objects, against those of one")
    fitting.set_defaults(run=run_fit)
    differing = commands.add_parser("fit_difference", help="of two poses that may make the same object")
    differing.add_argument("--fit", nargs="+", required=True, metavar="JSON")
    differing.add_argument("--check", nargs="+", required=True, metavar="JSON", help="of other objects")
    differing.add_argument("--header", help="written: src/alignment/difference_weights.h")
    differing.add_argument("--strength", type=float, default=1.0, help="of the penalty")
    differing.set_defaults(run=run_fit_difference)
    reporting = commands.add_parser("report")
    reporting.add_argument("json", nargs="+")
    reporting.add_argument("--failures", action="store_true", help="also every wrong and every refused pair")
    reporting.set_defaults(run=run_report)
    drawing = commands.add_parser("pictures", help="of every wrong and every refused pair")
    drawing.add_argument("json", nargs="+")
    drawing.add_argument("--parts", required=True, help="folder that benchmark_alignment --parts wrote")
    drawing.add_argument("--out", required=True)
    drawing.set_defaults(run=run_pictures)
    arguments = parser.parse_args()
    arguments.run(arguments)


if __name__ == "__main__":
    main()

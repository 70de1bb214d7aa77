#!/usr/bin/python3
"""Fits the confidence of the recogniser: logistic regressions on what benchmark_recognition --candidates wrote, right
where ADD (ADD-S for symmetric objects) is below 0.1 diameters. Prints weights for src/recognition/evidence.cpp, and
how often candidates of each confidence are right, by the fit and as they were given.

The score is fitted on all candidates, the confidence on those that are the best of their place. The second needs scores
by the first: put the weights of the score into evidence.cpp, build, write the candidates anew, and fit again.

    fit_confidence.py --frames frames.json a.csv=scenes_a b.csv=scenes_b [--symmetric 5 31] [--test c.csv=scenes_c]
"""

import argparse
import csv
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "evaluation_kit"))
from evalkit.bop import read_models, read_scene, scene_folders  # noqa: E402, after the path
from evalkit.geometry import inverse  # noqa: E402
from evalkit.pose_error import ObjectModel  # noqa: E402

NAMES = ["explained", "normals", "contour", "edges", "correlation", "high_correlation", "texture", "hue", "distance",
         "log_px", "occluded", "features", "flatness", "unmeasured"]
AGREEMENT = NAMES.index("correlation")
SECOND_NAMES = ["score", "lead", "explained", "agreement"]
SCORE = 5  # column; then the rival's score, the share explained, and the evidence
FIRST = 8
LEAST_SCORE, MOST_LEAD = -8, 5
BINS = [0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0001]


def right_pose(model, symmetric, truth, pose):
    """Whether the pose (T_camera_mesh) is that of one of the true objects."""
    for entry in truth:
        if np.linalg.norm(entry["pose"][:3, 3] - pose[:3, 3]) < 0.6 * model.diameter:
            error = model.adds if symmetric or model.symmetric else model.add
            if error(entry["pose"], pose) < 0.1 * model.diameter:
                return True
    return False


def load(argument, frames, symmetric):
    """(evidence, second evidence, right, confidence) of all candidates of a file."""
    path, dataset = argument.split("=", 1)
    models = {k: ObjectModel(mesh) for k, mesh in read_models(dataset).items()}
    scenes = {k: read_scene(folder) for k, folder in scene_folders(dataset).items()}
    evidence, second, right, confidence = [], [], [], []
    with open(path) as file:
        for row in csv.reader(file):
            scene, image, obj_id = int(row[0]), int(row[1]), int(row[2])
            numbers = np.array(row[FIRST:], float)
            if len(numbers) != len(NAMES) + 12:
                raise SystemExit(f"{path}: {len(row)} columns; write it with this version's benchmark_recognition")
            pose = np.eye(4)
            pose[:3] = numbers[len(NAMES):].reshape(3, 4)
            pose = pose @ frames.get(obj_id, np.eye(4))
            truth = [entry for entry in scenes[scene][image] if entry["obj_id"] == obj_id]
            evidence.append(numbers[:len(NAMES)])
            score, rival_score, explained = (float(value) for value in row[SCORE:FIRST])
            second.append([score, min(score - rival_score, MOST_LEAD), explained, numbers[AGREEMENT]])
            right.append(obj_id in models and right_pose(models[obj_id], obj_id in symmetric, truth, pose))
            confidence.append(float(row[4]))
    return np.array(evidence), np.array(second), np.array(right, float), np.array(confidence)


def fit(evidence, right, regularisation):
    """Offset and weights of a logistic regression; ridge on the standardised weights."""
    mean, deviation = evidence.mean(0), evidence.std(0) + 1e-9
    x = np.hstack([np.ones((len(evidence), 1)), (evidence - mean) / deviation])
    penalty = np.diag([0.0] + [regularisation] * evidence.shape[1])
    weights = np.zeros(x.shape[1])
    for _ in range(100):
        p = 1 / (1 + np.exp(-np.clip(x @ weights, -30, 30)))
        step = np.linalg.solve((x.T * (p * (1 - p) + 1e-9)) @ x + penalty, x.T @ (p - right) + penalty @ weights)
        weights -= step
        if np.abs(step).max() < 1e-8:
            break
    scaled = weights[1:] / deviation
    return weights[0] - scaled @ mean, scaled


def best(second):
    """Of their places, and with a score at all."""
    return (second[:, 1] >= 0) & (second[:, 0] > LEAST_SCORE)


def tell(offset_name, weights_name, names, offset, weights):
    print(f"constexpr float {offset_name} = {offset:.4f}F;")
    print(f"constexpr {weights_name} = {{ " + ", ".join(f"{w:.4f}F" for w in weights) + " };")
    print("  " + ", ".join(names))


def report(name, p, right):
    print(f"{name}: {len(p)} candidates, {int(right.sum())} right, Brier {np.mean((p - right) ** 2):.4f}")
    for low, high in zip(BINS, BINS[1:]):
        inside = (p >= low) & (p < high)
        if inside.any():
            print(f"  {low:.1f} to {min(high, 1):.1f}: {inside.sum():6d}, mean {p[inside].mean():.3f}, "
                  f"right {right[inside].mean():.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("candidates", nargs="+", help="CSV=SCENES, to fit on")
    parser.add_argument("--test", nargs="*", default=[], help="CSV=SCENES, to report on only")
    parser.add_argument("--frames", required=True, help="JSON file of model_frames.py")
    parser.add_argument("--symmetric", type=int, nargs="*", default=[], help="further ids judged by ADD-S")
    parser.add_argument("--regularisation", type=float, default=1.0)
    arguments = parser.parse_args()
    with open(arguments.frames) as file:
        frames = {int(k): inverse(np.array(v, float).reshape(4, 4)) for k, v in json.load(file).items()}
    sets = {a: load(a, frames, set(arguments.symmetric)) for a in arguments.candidates + arguments.test}
    used = [sets[a] for a in arguments.candidates]
    evidence, second, right = (np.concatenate([s[i] for s in used]) for i in range(3))
    offset, weights = fit(evidence, right, arguments.regularisation)
    tell("OFFSET", "Evidence WEIGHTS", NAMES, offset, weights)
    offset, weights = fit(second[best(second)], right[best(second)], arguments.regularisation)
    tell("CONFIDENCE_OFFSET", "std::array<float, 4> CONFIDENCE_WEIGHTS", SECOND_NAMES, offset, weights)
    for argument, (_, second, right, given) in sets.items():
        places = best(second)
        report(argument + ", fitted", 1 / (1 + np.exp(-(offset + second[places] @ weights))), right[places])
        report(argument + ", as given", given[places], right[places])


if __name__ == "__main__":
    main()

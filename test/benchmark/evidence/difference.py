"""Logistic regression of whether a rival pose makes the same object as the best one, given that the best one is right.

Fitted to the rivals of right poses, each weighted by its probability: improbable rivals carry little
information. Differences are evidence against it only, so that no weight is positive.
"""

import numpy as np
from scipy.optimize import minimize

NAMES = ("stray", "texture", "rivalry")  # as in object_difference.h


def examples(pairs):
    """Features (n, 3), whether the rival is right too (n), its probability (n)."""
    features, right, weights = [], [], []
    for pair in pairs:
        candidates = pair["candidates"]
        if not candidates or not candidates[0]["right"]:
            continue
        odds = np.array([c["log_odds"] for c in candidates])
        shift = max(0.0, odds.max())
        share = np.exp(odds - shift) / (np.exp(-shift) + np.exp(odds - shift).sum())
        for candidate, probability in zip(candidates, share):
            if "difference" in candidate:
                features.append([candidate["difference"][name] for name in NAMES])
                right.append(candidate["right"])
                weights.append(probability)
    return np.array(features).reshape(-1, len(NAMES)), np.array(right, float), np.array(weights)


def loss(parameters, features, right, weights, penalty):
    """Value and gradient; the last parameter, the bias, bears no penalty."""
    inside = np.column_stack([features, np.ones(len(features))])
    odds = inside @ parameters
    value = (weights * (np.logaddexp(0, odds) - right * odds)).sum() + 0.5 * penalty @ parameters**2
    return value, inside.T @ (weights * (1 / (1 + np.exp(-odds)) - right)) + penalty * parameters


def fit_difference(features, right, weights, strength=1.0):
    """Parameters (4), the bias last, and their standard errors. Features are scaled to unit deviation for the penalty."""
    penalty = np.append(strength * features.var(0), 1e-6)
    bounds = [(None, 0)] * features.shape[1] + [(None, None)]
    found = minimize(loss, np.zeros(features.shape[1] + 1), (features, right, weights, penalty), jac=True,
                     method="L-BFGS-B", bounds=bounds, options={"maxiter": 2000, "ftol": 1e-12, "gtol": 1e-8}).x
    inside = np.column_stack([features, np.ones(len(features))])
    p = 1 / (1 + np.exp(-inside @ found))
    curvature = (inside * (weights * p * (1 - p))[:, None]).T @ inside + np.diag(penalty)
    return found, np.sqrt(np.maximum(np.diag(np.linalg.pinv(curvature)), 0))


def difference_header(parameters, errors, count):
    lines = ["#pragma once", "",
             "// Written by test/benchmark/evidence/alignment_evidence.py fit_difference; docs/alignment.md. Not to be edited "
             "by hand.", f"// Fitted on {count} rivals of right poses.", "namespace object_modelling::alignment", "{",
             f"constexpr double DIFFERENCE_BIAS = {parameters[-1]:.4f};  // +- {errors[-1]:.2f}",
             "constexpr double DIFFERENCE_WEIGHTS[] = {"]
    lines += [f"  {w:.4f},  // {n}, +- {e:.2f}" for n, w, e in zip(NAMES, parameters, errors)]
    return "\n".join(lines + ["};", "}  // namespace object_modelling::alignment", ""])

"""Conditional logistic regression: of the poses found for a pair, which is right, or that none is.

A pose with features x has the odds exp(w x + b) against "none is right", whose odds are 1. Of a symmetric object several
poses may be right; then their probabilities add up. McFadden, Conditional logit analysis of qualitative choice behavior,
1974; with an L2 penalty.
"""

import numpy as np
from scipy.optimize import minimize
from scipy.special import logsumexp


class Choice:
    """One pair: features (n, k) of its poses, which of them are right (n), what is known before (n), its weight."""

    def __init__(self, features, right, prior, weight=1.0):
        self.features, self.right, self.prior, self.weight = features, np.asarray(right, bool), prior, weight


def log_odds(parameters, choice):
    return choice.features @ parameters[:-1] + parameters[-1] + choice.prior


def negative_log_likelihood(parameters, choices, penalty):
    """Value and gradient; the last parameter, the bias, bears no penalty."""
    value, gradient = 0.5 * penalty @ parameters**2, penalty * parameters
    for choice in choices:
        odds = log_odds(parameters, choice)
        everything = np.append(odds, 0.0)
        total = logsumexp(everything)
        share = np.exp(everything - total)
        inside = np.column_stack([choice.features, np.ones(len(odds))])
        right = np.append(choice.right, not choice.right.any())
        chosen = logsumexp(everything[right])
        among = np.where(right, np.exp(everything - chosen), 0.0)
        value -= choice.weight * (chosen - total)
        gradient = gradient + choice.weight * ((share - among)[:-1] @ inside)
    return value, gradient


def fit(choices, strength=1.0, non_negative=(), non_positive=()):
    """Parameters (k + 1), the bias last, and their standard errors. Features are scaled to unit deviation for the
    penalty. `non_negative`, `non_positive`: indices of features that can only speak for a pose, or against one."""
    stacked = np.concatenate([c.features for c in choices])
    penalty = np.append(strength * stacked.var(0) / 4, 1e-6)
    count = stacked.shape[1]
    bounds = [(0 if k in non_negative else None, 0 if k in non_positive else None) for k in range(count)] + [(None, None)]
    found = minimize(negative_log_likelihood, np.zeros(count + 1), (choices, penalty), jac=True, method="L-BFGS-B",
                     bounds=bounds, options={"maxiter": 2000, "ftol": 1e-12, "gtol": 1e-8})
    return found.x, standard_errors(found.x, choices, penalty)


def standard_errors(parameters, choices, penalty):
    """From the curvature at the optimum."""
    step = 1e-4
    curvature = np.array([
        (negative_log_likelihood(parameters + step * e, choices, penalty)[1]
         - negative_log_likelihood(parameters - step * e, choices, penalty)[1]) / (2 * step)
        for e in np.eye(len(parameters))])
    return np.sqrt(np.maximum(np.diag(np.linalg.pinv((curvature + curvature.T) / 2)), 0))


def calibrate(parameters, choices):
    """Scale and shift of the odds that make other data most likely (Platt 1999): new parameters, scale, shift."""
    rescaled = [Choice(log_odds(np.append(parameters[:-1], 0.0), c)[:, None] - np.reshape(c.prior, (-1, 1)), c.right,
                       c.prior, c.weight) for c in choices]
    found = minimize(negative_log_likelihood, np.array([1.0, parameters[-1]]), (rescaled, np.array([0.0, 1e-6])),
                     jac=True, method="L-BFGS-B", bounds=[(0.2, 3.0), (None, None)])
    scale, shift = found.x
    return np.append(scale * parameters[:-1], shift), scale, shift


def probabilities(parameters, choice):
    odds = np.append(log_odds(parameters, choice), 0.0)
    return np.exp(odds - logsumexp(odds))[:-1]

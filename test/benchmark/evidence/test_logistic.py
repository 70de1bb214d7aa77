"""The fit finds what data were made by, and its derivatives are right."""

import numpy as np
from logistic import Choice, calibrate, fit, negative_log_likelihood, probabilities


def made_by(weights, bias, pairs, seed, poses=6):
    """Choices among random poses, the right one drawn by the model's own probabilities, or none."""
    rng = np.random.default_rng(seed)
    choices = []
    for _ in range(pairs):
        choice = Choice(rng.normal(size=(poses, len(weights))), np.zeros(poses), np.zeros(poses))
        share = probabilities(np.append(weights, bias), choice)
        drawn = rng.choice(poses + 1, p=np.append(share, 1 - share.sum()))
        choice.right = np.arange(poses) == drawn
        choices.append(choice)
    return choices


def test_weights_are_found_within_their_errors():
    weights, bias = np.array([1.5, -0.7, 0.0]), -1.0
    parameters, errors = fit(made_by(weights, bias, 3000, 1), strength=1e-3)
    assert np.all(np.abs(parameters - np.append(weights, bias)) < 4 * errors)
    assert np.all(errors < 0.2)


def test_gradient_is_that_of_the_value():
    choices = made_by(np.array([1.0, 2.0]), 0.5, 20, 2)
    choices[3].prior = np.linspace(-3, 1, 6)
    choices[4].right = np.array([True, True, False, False, False, True])  # a symmetric object
    choices[5].weight = 0.3
    at, penalty = np.array([0.3, -0.4, 0.2]), np.array([0.1, 0.2, 0.0])
    gradient = negative_log_likelihood(at, choices, penalty)[1]
    for k, step in enumerate(1e-6 * np.eye(3)):
        slope = (negative_log_likelihood(at + step, choices, penalty)[0]
                 - negative_log_likelihood(at - step, choices, penalty)[0]) / 2e-6
        assert abs(slope - gradient[k]) < 1e-5


def test_what_speaks_for_a_pose_never_speaks_against_it():
    parameters, _ = fit(made_by(np.array([-2.0, 1.0]), 0.0, 200, 3), non_negative=[0])
    assert parameters[0] == 0 and parameters[1] > 0


def test_calibration_takes_back_what_was_too_sure():
    truth = np.array([1.0, -0.5, 0.3])
    too_sure = np.append(2 * truth[:-1], 2.0)
    parameters, scale, _ = calibrate(too_sure, made_by(truth[:-1], truth[-1], 4000, 4))
    assert abs(scale - 0.5) < 0.1
    assert np.allclose(parameters, truth, atol=0.15)

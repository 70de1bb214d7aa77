import numpy as np
import pytest
from difference import NAMES, difference_header, examples, fit_difference, loss


def candidate(right, log_odds, stray=None):
    made = {"right": right, "log_odds": log_odds}
    if stray is not None:
        made["difference"] = {"stray": stray, "texture": -3.0, "rivalry": 1.0}
    return made


def test_examples_are_rivals_of_right_poses_by_their_probability():
    pairs = [{"candidates": [candidate(True, 2.0), candidate(True, 2.0, -5.0), candidate(False, 0.0, -1.0)]},
             {"candidates": [candidate(False, 2.0), candidate(True, 1.0, -5.0)]},
             {"candidates": []}]
    features, right, weights = examples(pairs)
    assert features.tolist() == [[-5.0, -3.0, 1.0], [-1.0, -3.0, 1.0]]
    assert right.tolist() == [1.0, 0.0]
    everything = 2 * np.exp(2.0) + np.exp(0.0) + 1
    assert weights == pytest.approx([np.exp(2.0) / everything, 1 / everything])


def test_odds_beyond_overflow_are_shares_all_the_same():
    _, _, weights = examples([{"candidates": [candidate(True, 3000.0), candidate(True, 3000.0, -5.0)]}])
    assert weights == pytest.approx([0.5])


def test_no_pair_gives_no_example():
    features, right, weights = examples([])
    assert features.shape == (0, len(NAMES)) and len(right) == len(weights) == 0


def test_the_gradient_is_that_of_the_value():
    random = np.random.default_rng(3)
    features, right, weights = random.normal(size=(20, 3)), random.integers(0, 2, 20), random.uniform(size=20)
    penalty, at = np.array([1.0, 0.5, 2.0, 0.0]), random.normal(size=4)
    gradient = loss(at, features, right, weights, penalty)[1]
    for k, step in enumerate(1e-6 * np.eye(4)):
        numeric = (loss(at + step, features, right, weights, penalty)[0]
                   - loss(at - step, features, right, weights, penalty)[0]) / 2e-6
        assert gradient[k] == pytest.approx(numeric, rel=1e-5, abs=1e-8)


def test_known_weights_are_found_again_and_none_is_positive():
    random = np.random.default_rng(5)
    features = random.normal(size=(20000, 3))
    true = np.array([-1.5, -0.5, 0.4, 0.8])  # the third would speak for a rival: it is held at nothing
    right = random.uniform(size=len(features)) < 1 / (1 + np.exp(-(features @ true[:3] + true[3])))
    found, errors = fit_difference(features, right.astype(float), np.ones(len(features)))
    assert found[[0, 1, 3]] == pytest.approx([-1.45, -0.48, 0.77], abs=0.08)
    assert found[2] == 0
    assert (errors < 0.05).all()


def test_the_header_names_every_weight():
    text = difference_header(np.array([-1.0, -2.0, -3.0, 4.0]), np.ones(4), 7)
    assert "DIFFERENCE_BIAS = 4.0000" in text
    for name, weight in zip(NAMES, (-1, -2, -3)):
        assert f"{weight}.0000,  // {name}," in text

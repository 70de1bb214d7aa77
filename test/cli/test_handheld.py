"""The simulated handheld cut: the trajectory against its exact truth, live and refined, and twice the same."""

import os
import tempfile
import unittest

import numpy as np

from command import HANDHELD, run_json


def read_trajectory(path):
    """Stamps (n,) and positions (n, 3) of a TUM file."""
    rows = np.loadtxt(path, ndmin=2)
    return rows[:, 0], rows[:, 1:4]


def absolute_error_m(estimate_path, truth_path):
    """Root mean square position error after the best rigid alignment (Horn 1987)."""
    stamps, estimate = read_trajectory(estimate_path)
    truth_stamps, truth = read_trajectory(truth_path)
    truth = truth[np.abs(truth_stamps[None, :] - stamps[:, None]).argmin(axis=1)]
    a, b = estimate - estimate.mean(0), truth - truth.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    return np.sqrt(((a @ u @ sign @ vt - b) ** 2).sum(1).mean())


class HandheldTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.live, cls.refined, cls.again = (os.path.join(cls.folder.name, name) for name in ("live", "refined", "again"))
        cls.result = run_json("track", HANDHELD, "--trajectory", cls.live, "--refined-trajectory", cls.refined)

    def test_tracked(self):
        self.assertGreaterEqual(self.result["tracked_ratio"], 0.99)

    def test_accuracy(self):
        truth = os.path.join(HANDHELD, "groundtruth.txt")
        self.assertLessEqual(absolute_error_m(self.live, truth), 0.005)
        self.assertLessEqual(absolute_error_m(self.refined, truth), 0.003)

    def test_the_same_recording_gives_the_same_trajectory(self):
        run_json("track", HANDHELD, "--trajectory", self.again)
        with open(self.live, "rb") as first, open(self.again, "rb") as second:
            self.assertEqual(first.read(), second.read())


if __name__ == "__main__":
    unittest.main()

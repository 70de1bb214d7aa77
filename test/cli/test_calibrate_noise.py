"""A sensor's noise from a recording whose table serves as the wall, and what the other commands do with it."""

import os
import tempfile
import unittest

import yaml

from command import HANDHELD, run, run_json


class CalibrateNoiseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.noise = os.path.join(cls.folder.name, "noise.yaml")
        cls.result = run_json("calibrate_noise", HANDHELD, "--output", cls.noise)

    def test_the_kinect_is_found_again(self):
        self.assertGreater(self.result["used_count"], 100)
        self.assertEqual(self.result["used_count"] + sum(self.result["unused"].values()), self.result["frame_count"])
        self.assertTrue(self.result["coefficients"]["axial_constant_m"]["fitted"])
        with open(self.noise) as text:
            model = yaml.safe_load(text)
        sigma_m = model["axial_constant_m"] + model["axial_quadratic_per_m"] * (0.7 - model["axial_vertex_m"]) ** 2
        self.assertAlmostEqual(sigma_m, 0.0012 + 0.0019 * 0.3 ** 2, delta=0.0002)

    def test_what_a_wall_does_not_show_is_named(self):
        bias = self.result["coefficients"]["depth_bias_linear_ratio"]
        self.assertFalse(bias["fitted"])
        self.assertIn("--distances", bias["reason"])
        with open(self.noise) as text:
            head = text.read()
        self.assertIn("depth_bias_linear_ratio", head)

    def test_other_commands_take_it(self):
        tracked = run_json("track", HANDHELD, "--noise-model", self.noise)
        self.assertEqual(tracked["tracked_count"], tracked["frame_count"])

    def test_a_model_that_is_none_is_refused(self):
        path = os.path.join(self.folder.name, "bad.yaml")
        with open(path, "w") as text:
            text.write("axial_constant: 0.001\n")
        finished = run("track", HANDHELD, "--noise-model", path)
        self.assertEqual(finished.returncode, 1)
        self.assertIn("axial_constant", finished.stderr)

    def test_distances_of_other_frames_are_refused(self):
        path = os.path.join(self.folder.name, "distances.txt")
        with open(path, "w") as text:
            text.write("1 0.7\n")
        finished = run("calibrate_noise", HANDHELD, "--distances", path, "--output", self.noise + ".2")
        self.assertEqual(finished.returncode, 1)
        self.assertIn("measured distances", finished.stderr)
        self.assertFalse(os.path.exists(self.noise + ".2"))


if __name__ == "__main__":
    unittest.main()

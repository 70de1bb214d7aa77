"""The shift of colour against depth images: found, written, and gone from what is tracked with it."""

import os
import tempfile
import unittest

import yaml

from command import HANDHELD, run, run_json


class CalibrateColorOffsetTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.noise = os.path.join(cls.folder.name, "noise.yaml")
        with open(cls.noise, "w") as text:
            text.write("axial_constant_m: 0.0013\n")
        cls.result = run_json("calibrate_color_offset", HANDHELD, "--noise-model", cls.noise, "--output", cls.noise)

    def test_is_that_of_the_simulated_sensor(self):
        x_px, y_px = self.result["color_offset_px"]
        self.assertAlmostEqual(x_px, 0.2, delta=0.2)
        self.assertAlmostEqual(y_px, 0.4, delta=0.2)

    def test_one_recording_alone_is_said_to_be_little(self):
        finished = run("calibrate_color_offset", HANDHELD, "--output", self.noise + ".3")
        self.assertIn("give two or more", finished.stdout)

    def test_file_keeps_the_rest_of_the_noise_model(self):
        with open(self.noise) as text:
            model = yaml.safe_load(text)
        self.assertEqual(model["axial_constant_m"], 0.0013)
        self.assertAlmostEqual(model["color_offset_y_px"], self.result["color_offset_px"][1], places=9)

    def test_again_finds_the_same(self):
        again = run_json("calibrate_color_offset", HANDHELD, "--noise-model", self.noise, "--output", self.noise + ".2")
        self.assertEqual(again["color_offset_px"], self.result["color_offset_px"])

    def test_refinement_takes_it_as_known(self):
        for options, known in ([], False), (["--noise-model", self.noise], True):
            tracked = run_json("track", HANDHELD, "--refinement", "bundle_adjustment", "--refined-trajectory",
                               os.path.join(self.folder.name, "refined.txt"), *options)
            self.assertEqual(tracked["refinement"]["color_offset_px"] == [0, 0], known)

    def test_output_that_cannot_be_is_refused_at_once(self):
        finished = run("calibrate_color_offset", HANDHELD, "--output", os.path.join(self.folder.name, "none", "n.yaml"))
        self.assertNotEqual(finished.returncode, 0)
        self.assertIn("folder that exists", finished.stderr)


if __name__ == "__main__":
    unittest.main()

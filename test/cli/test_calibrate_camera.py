"""What a camera is off by: found, written, and gone from what is tracked with it."""

import math
import os
import tempfile
import unittest

import yaml

from command import HANDHELD, run, run_json

TRUE_DISTORTION = [[-0.00087, -0.00070, 0.00068], [-0.00046, 0.00184, -0.00051], [0.00097, 0.00088, -0.00114]]


def part_of(recording, folder, first):
    """Every other frame of a recording."""
    os.makedirs(folder)
    for name in os.listdir(recording):
        if name != "associations.txt":
            os.symlink(os.path.join(recording, name), os.path.join(folder, name))
    with open(os.path.join(recording, "associations.txt")) as text:
        lines = [line for line in text if not line.startswith("#")]
    with open(os.path.join(folder, "associations.txt"), "w") as text:
        text.writelines(lines[first::2])
    return folder


def correlation(a, b):
    mean_a, mean_b = sum(a) / len(a), sum(b) / len(b)
    product = sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b))
    return product / math.sqrt(sum((x - mean_a) ** 2 for x in a) * sum((y - mean_b) ** 2 for y in b))


class CalibrateCameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.noise = os.path.join(cls.folder.name, "noise.yaml")
        with open(cls.noise, "w") as text:
            text.write("axial_constant_m: 0.0013\n")
        cls.result = run_json("calibrate_camera", HANDHELD, "--noise-model", cls.noise, "--output", cls.noise)

    def test_is_that_of_the_simulated_sensor(self):
        x_px, y_px = self.result["color_offset_px"]
        self.assertAlmostEqual(x_px, 0.2, delta=0.2)
        self.assertAlmostEqual(y_px, 0.4, delta=0.2)

    def test_one_recording_alone_is_said_to_be_little(self):
        finished = run("calibrate_camera", HANDHELD, "--output", self.noise + ".3")
        self.assertIn("give two or more", finished.stdout)

    def test_file_keeps_the_rest_of_the_noise_model(self):
        with open(self.noise) as text:
            model = yaml.safe_load(text)
        self.assertEqual(model["axial_constant_m"], 0.0013)
        self.assertAlmostEqual(model["color_offset_y_px"], self.result["color_offset_px"][1], places=9)

    def test_again_finds_the_same(self):
        again = run_json("calibrate_camera", HANDHELD, "--noise-model", self.noise, "--output", self.noise + ".2")
        self.assertEqual(again["color_offset_px"], self.result["color_offset_px"])

    def test_refinement_takes_it_as_known(self):
        for options, known in ([], False), (["--noise-model", self.noise], True):
            tracked = run_json("track", HANDHELD, "--refinement", "bundle_adjustment", "--refined-trajectory",
                               os.path.join(self.folder.name, "refined.txt"), *options)
            self.assertEqual(tracked["refinement"]["color_offset_px"] == [0, 0], known)

    def test_distortion_needs_a_second_recording(self):
        self.assertNotIn("depth_distortion", self.result)
        with open(self.noise) as text:
            self.assertNotIn("depth_distortion_ratio", yaml.safe_load(text))

    def test_distortion_is_taken_if_two_recordings_agree(self):
        parts = [part_of(HANDHELD, os.path.join(self.folder.name, "part_%d" % first), first) for first in (0, 1)]
        result = run_json("calibrate_camera", *parts, "--output", self.noise + ".4")
        distortion = result["depth_distortion"]
        with open(self.noise + ".4") as text:
            written = yaml.safe_load(text)
        self.assertEqual(distortion["agrees"], "depth_distortion_ratio" in written)
        self.assertTrue(distortion["agrees"], distortion)
        # Of the simulated sensor, at the knots that the bottle and the papers round it lie between.
        found = [row[3:6] for row in written["depth_distortion_ratio"][2:5]]
        self.assertGreater(correlation(sum(found, []), sum(TRUE_DISTORTION, [])), 0.6)

    def test_output_that_cannot_be_is_refused_at_once(self):
        finished = run("calibrate_camera", HANDHELD, "--output", os.path.join(self.folder.name, "none", "n.yaml"))
        self.assertNotEqual(finished.returncode, 0)
        self.assertIn("folder that exists", finished.stderr)


if __name__ == "__main__":
    unittest.main()

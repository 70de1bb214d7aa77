"""compare: known distances, files that it writes, and clear words for what cannot be compared."""

import json
import math
import os
import struct
import tempfile
import unittest

from command import run, run_json

SIZE_M = (0.12, 0.07, 0.18)


def box_points(steps):
    """Points on the faces of a box with a bump, and its quads as triangles."""
    points, triangles = [], []
    for low, size in (((0, 0, 0), SIZE_M), ((0.12, 0.01, 0.1), (0.04, 0.02, 0.05))):
        for axis in range(3):
            for side in (0, 1):
                first = len(points)
                u, v = (axis + 1) % 3, (axis + 2) % 3
                for i in range(steps + 1):
                    for j in range(steps + 1):
                        point = list(low)
                        point[axis] += side * size[axis]
                        point[u] += size[u] * i / steps
                        point[v] += size[v] * j / steps
                        points.append(point)
                for i in range(steps):
                    for j in range(steps):
                        a = first + i * (steps + 1) + j
                        triangles += [(a, a + steps + 1, a + steps + 2), (a, a + steps + 2, a + 1)]
    return points, triangles


def write_ply(path, points, triangles=()):
    with open(path, "wb") as out:
        out.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                   "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n" %
                   (len(points), len(triangles))).encode())
        for point in points:
            out.write(struct.pack("<3f", *point))
        for triangle in triangles:
            out.write(struct.pack("<B3i", 3, *triangle))


def turned(points, shift):
    """150 degrees about z and shifted."""
    c, s = math.cos(math.radians(150)), math.sin(math.radians(150))
    return [(c * x - s * y + shift[0], s * x + c * y + shift[1], z + shift[2]) for x, y, z in points]


class CompareTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.reference = self.path("reference.ply")
        write_ply(self.reference, *box_points(3))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def model(self, name="model.ply", scale=1.0):
        points, triangles = box_points(15)
        write_ply(self.path(name), [[scale * value for value in point] for point in turned(points, (0.4, -0.3, 0.1))],
                  triangles)
        return self.path(name)

    def assert_refused(self, finished, *words):
        self.assertEqual(finished.returncode, 1, finished.stderr)
        for word in words:
            self.assertIn(word, finished.stderr)

    def test_displaced_model_is_found_and_files_are_written(self):
        model = self.model("a model;$(touch evil) '\" & co.ply")
        result = run_json("compare", model, self.reference, "--transform", self.path("T.txt"), "--cloud",
                          self.path("cloud.ply"), "--histogram", self.path("histogram.png"))
        self.assertLess(result["distance_mm"]["max"], 0.01)
        self.assertEqual(result["beyond_5mm_ratio"], 0)
        self.assertTrue(result["converged"])
        angle = math.degrees(math.atan2(result["reference_from_model"][1][0], result["reference_from_model"][0][0]))
        self.assertAlmostEqual(angle, -150, places=2)
        self.assertEqual(sum(result["histogram"]["counts"]), result["point_count"])
        self.assertTrue(all(os.path.getsize(self.path(name)) for name in ("T.txt", "cloud.ply", "histogram.png")))
        self.assertFalse(os.path.exists("evil"))
        again = run_json("compare", model, self.reference, "--no-align", "--init", self.path("T.txt"))
        self.assertLess(again["distance_mm"]["max"], 0.01)
        unplaced = run_json("compare", model, self.reference, "--no-align")
        self.assertGreater(unplaced["distance_mm"]["mean"], 100)
        self.assertEqual(unplaced["beyond_5mm_ratio"], 1)

    def test_millimetres(self):
        model = self.model(scale=1000)
        self.assert_refused(run("compare", model, self.reference), "--model-unit mm")
        self.assertLess(run_json("compare", model, self.reference, "--model-unit", "mm")["distance_mm"]["max"], 0.01)

    def test_text_warns_of_another_size(self):
        text = run("compare", self.model(scale=2), self.reference).stdout
        self.assertIn("WARNING", text)
        self.assertIn("mean", text)

    def test_what_cannot_be_compared(self):
        model = self.model()
        self.assert_refused(run("compare", self.path("nothing.ply"), self.reference), "nothing.ply")
        self.assert_refused(run("compare", model, self.folder), self.folder)
        write_ply(self.path("cloud.ply"), [(0, 0, 0), (1, 0, 0)])
        self.assert_refused(run("compare", model, self.path("cloud.ply")), "cloud.ply", "triangles")
        write_ply(self.path("triangle.ply"), [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)], [(0, 1, 2)])
        self.assert_refused(run("compare", model, self.path("triangle.ply")), "1 triangles")
        write_ply(self.path("nan.ply"), [(0, 0, float("nan"))] * 3, [(0, 1, 2)])
        self.assert_refused(run("compare", self.path("nan.ply"), self.reference), "nan.ply", "finite")
        self.assert_refused(run("compare", model, self.path("nan.ply")), "nan.ply", "finite")
        with open(self.path("T.txt"), "w") as text:
            text.write("1 2 3")
        self.assert_refused(run("compare", model, self.reference, "--init", self.path("T.txt")), "T.txt", "16 numbers")
        self.assert_refused(run("compare", model, self.reference, "--cloud", self.path("no", "cloud.ply")), "cloud.ply")
        finished = run("compare", model, self.path("nan.ply"), "--json")
        self.assertEqual(json.loads(finished.stdout)["status"]["code"], 4)
        self.assertEqual(run("compare", model).returncode, 2)


if __name__ == "__main__":
    unittest.main()

"""Objects of a database in single images: unusable images are skipped and told, numbers of the results are unique."""

import csv
import os
import shutil
import tempfile
import unittest

import cv2
import numpy
from command import CLUTTER, DATA, HANDHELD, run, run_json

MESHES = os.path.join(DATA, "..", "..", "evaluation_kit", "objects")
STAMPS = ["1.000000", "1.100000", "1.200000", "1.300000"]
SURE = 0.5  # of the bottle, whose views are rendered; there is one in each image


class RecogniseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.root.cleanup)
        cls.database = os.path.join(cls.root.name, "objects")
        for object_id, mesh in (("7_bottle", "006_mustard_bottle"), ("7_can", "005_tomato_soup_can"),
                                ("1_box", "004_sugar_box")):
            run_json("import_mesh", os.path.join(MESHES, mesh, "textured.obj"), cls.database, "--id", object_id)

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.csv = os.path.join(self.folder.name, "results.csv")

    def recording(self, name="clip"):
        """Four images: the second is cut off, the third has no depth."""
        folder = os.path.join(self.folder.name, name)
        for kind, extension in (("rgb", "jpg"), ("depth", "png")):
            os.makedirs(os.path.join(folder, kind))
            for stamp in STAMPS:
                shutil.copy(os.path.join(CLUTTER, kind, "000000." + extension),
                            os.path.join(folder, kind, "%s.%s" % (stamp, extension)))
            with open(os.path.join(folder, kind + ".txt"), "w") as rows:
                rows.writelines("%s %s/%s.%s\n" % (stamp, kind, stamp, extension) for stamp in STAMPS)
        shutil.copy(os.path.join(HANDHELD, "camera.yaml"), folder)
        with open(os.path.join(folder, "rgb", STAMPS[1] + ".jpg"), "r+b") as image:
            image.truncate(2000)
        cv2.imwrite(os.path.join(folder, "depth", STAMPS[2] + ".png"), numpy.zeros((480, 640), numpy.uint16))
        return folder

    def scene(self):
        """BOP: image 3 cannot be read, 11 can."""
        folder = os.path.join(self.folder.name, "000012")
        for kind in ("rgb", "depth"):
            os.makedirs(os.path.join(folder, kind))
        with open(os.path.join(folder, "rgb", "000003.jpg"), "w") as image:
            image.write("no image")
        shutil.copy(os.path.join(CLUTTER, "rgb", "000001.jpg"), os.path.join(folder, "rgb", "000011.jpg"))
        for number in (3, 11):
            shutil.copy(os.path.join(CLUTTER, "depth", "000001.png"), os.path.join(folder, "depth", "%06d.png" % number))
        camera = '{"cam_K": [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1], "depth_scale": 1.0}'
        with open(os.path.join(folder, "scene_camera.json"), "w") as text:
            text.write('{"3": %s, "11": %s}' % (camera, camera))
        return folder

    def sure(self, *columns):
        """Of the rows with the number of the bottle where there are two objects of the number 7."""
        return {tuple(row[name] for name in columns) for row in self.rows(self.csv)
                if row["obj_id"] == "2" and float(row["score"]) > SURE}

    @staticmethod
    def rows(path):
        with open(path) as text:
            return list(csv.DictReader(text))

    def test_unusable_images_are_skipped_and_told(self):
        clip, scene = self.recording(), self.scene()
        finished = run("recognise", clip, scene, "--database", self.database, "--csv", self.csv)
        self.assertEqual(finished.returncode, 1, finished.stderr)
        self.assertIn("3 of 6 images could not be used, the first: %s image 1" % clip, finished.stderr)
        self.assertIn("3 images not usable", finished.stdout)
        for told in (clip + " image 1: not usable", clip + " image 2: not usable", scene + " image 3: not usable"):
            self.assertIn(told, finished.stdout)
        self.assertEqual(self.sure("scene_id", "im_id"), {("1", "0"), ("1", "3"), ("12", "11")})

    def test_numbers_are_unique_and_told(self):
        clip = self.recording()
        finished = run("recognise", clip, "--every", "4", "--database", self.database, "--csv", self.csv)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        numbers = {row["name"]: (row["kind"], row["number"])
                   for row in self.rows(os.path.join(self.folder.name, "results.numbers.csv"))}
        self.assertEqual(numbers, {"1_box": ("object", "1"), "7_bottle": ("object", "2"), "7_can": ("object", "3"),
                                   clip: ("scene", "1")})
        self.assertIn("object,2,7_bottle", finished.stdout)
        self.assertEqual(self.sure("scene_id", "im_id"), {("1", "0")})

    def test_own_numbers_stay(self):
        scene = self.scene()
        os.remove(os.path.join(scene, "rgb", "000003.jpg"))
        finished = run("recognise", scene + "/", "--id", "7_bottle", "--id", "7_bottle", "--database", self.database,
                       "--csv", self.csv, "--json")
        self.assertEqual(finished.returncode, 1, finished.stderr)
        self.assertEqual({(row["scene_id"], row["obj_id"]) for row in self.rows(self.csv)}, {("12", "7")})
        self.assertFalse(os.path.exists(os.path.join(self.folder.name, "results.numbers.csv")))
        self.assertIn("1 objects", run("recognise", scene, "--id", "7_bottle", "--id", "7_bottle", "--every", "5",
                                       "--database", self.database).stdout)


if __name__ == "__main__":
    unittest.main()

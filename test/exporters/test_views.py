"""Formats with views: depth, masks and poses fit each other and the exact box that was looked at."""
import glob
import json
import os
import tempfile
import unittest

import cv2
import loaders
import numpy as np
import small_database
import yaml
from object_modelling.exporters import command
from small_database import CAMERA, SIZE_M, SIZE_PX, VIEWS

HALF_PIXEL_DEPTH_M = 1e-4  # rounding of the images


def surface_distance(points):
    """Largest distance of points from the box's surface, m."""
    outside = np.abs(points) - SIZE_M / 2
    distances = np.where((outside < 0).all(1), np.abs(outside.max(1)), np.linalg.norm(np.maximum(outside, 0), axis=1))
    return distances.max()


def points_of(depth_m, mask, camera):
    rows, columns = np.nonzero(mask)
    z = depth_m[rows, columns]
    return np.stack([(columns - camera[0, 2]) / camera[0, 0] * z, (rows - camera[1, 2]) / camera[1, 1] * z, z], 1)


class ViewsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = folder.name
        small_database.write_object(cls.root, "box", version_2=True)
        small_database.write_object(cls.root, "one", sessions=("alone",))

    def export(self, format_name, *object_ids):
        return command.export_objects(self.root, object_ids, format_name)[0]

    def assert_view(self, number, colour, depth_m, mask, camera, camera_from_model):
        expected = small_database.model_from_camera(number)
        np.testing.assert_allclose(camera_from_model @ expected, np.eye(4), atol=1e-9)
        np.testing.assert_allclose(camera, CAMERA)
        self.assertEqual(colour.shape[:2], SIZE_PX[::-1])
        self.assertEqual(colour[7, 9].tolist(), [7, 9, 10 * number])
        np.testing.assert_array_equal(mask > 0, small_database.depth_of_box(expected) > 0)
        points = points_of(depth_m, mask, camera) @ expected[:3, :3].T + expected[:3, 3]
        self.assertGreater(len(points), 500)
        self.assertLess(surface_distance(points), 10 * HALF_PIXEL_DEPTH_M)
        self.assertTrue((depth_m[0] == 0).all())
        self.assertAlmostEqual(depth_m[1, 1], small_database.TABLE_M, 3)

    def test_bop_sequences(self):
        folder = os.path.join(self.export("bop"), "onboarding_static")
        self.assertEqual(sorted(os.listdir(folder)), ["obj_000001_down", "obj_000001_up", "obj_000002_up"])
        for sequence, first in (("obj_000001_up", 0), ("obj_000001_down", VIEWS)):
            content = {}
            for name in ("scene_camera", "scene_gt", "scene_gt_info"):
                with open(os.path.join(folder, sequence, name + ".json")) as text:
                    content[name] = json.load(text)
                self.assertEqual(sorted(content[name]), [str(i) for i in range(VIEWS)])
            for i in range(VIEWS):
                camera, pose = content["scene_camera"][str(i)], content["scene_gt"][str(i)][0]
                self.assertEqual(pose["obj_id"], 1)
                camera_from_model = np.eye(4)
                camera_from_model[:3, :3] = np.reshape(pose["cam_R_m2c"], (3, 3))
                camera_from_model[:3, 3] = np.array(pose["cam_t_m2c"]) / 1000

                def image(kind, name):
                    return cv2.imread(os.path.join(folder, sequence, kind, name + ".png"), cv2.IMREAD_UNCHANGED)
                depth = image("depth", "%06d" % i)
                self.assertEqual(depth.dtype, np.uint16)
                visible, silhouette = image("mask_visib", "%06d_000000" % i), image("mask", "%06d_000000" % i)
                self.assert_view(first + i, image("rgb", "%06d" % i), depth * camera["depth_scale"] / 1000, visible,
                                 np.reshape(camera["cam_K"], (3, 3)), camera_from_model)
                self.assert_silhouette(silhouette, visible, content["scene_gt_info"][str(i)][0])

    def assert_silhouette(self, silhouette, visible, info):
        """That of the mesh is the mask, but for a rim of a pixel."""
        self.assertFalse((visible & ~silhouette).any())
        self.assertFalse((silhouette & ~cv2.dilate(visible, np.ones((3, 3)))).any())
        self.assertEqual(info["px_count_all"], np.count_nonzero(silhouette))
        self.assertEqual(info["px_count_visib"], np.count_nonzero(visible))
        self.assertGreater(info["visib_fract"], 0.9)
        self.assertEqual(info["bbox_visib"], list(cv2.boundingRect(visible)))

    def test_bop_models(self):
        folder = self.export("bop")
        with open(os.path.join(folder, "models", "models_info.json")) as text:
            info = json.load(text)
        self.assertAlmostEqual(info["1"]["diameter"], 1000 * np.linalg.norm(SIZE_M), 6)
        for i, axis in enumerate("xyz"):
            self.assertAlmostEqual(info["1"]["min_" + axis], -500 * SIZE_M[i], 4)
            self.assertAlmostEqual(info["1"]["size_" + axis], 1000 * SIZE_M[i], 4)
        turns = sorted(np.reshape(turn, (4, 4)).round(9).tolist() for turn in info["1"]["symmetries_discrete"])
        self.assertEqual([np.diag(turn).tolist() for turn in turns],
                         [[-1, -1, 1, 1], [-1, 1, -1, 1], [1, -1, -1, 1]])  # the last two make the first
        self.assertNotIn("symmetries_continuous", info["1"])
        self.assertNotIn("symmetries_discrete", info["2"])
        for models in ("models", "models_eval"):
            loaded = loaders.Loaded(os.path.join(folder, models, "obj_000001.ply"))
            np.testing.assert_allclose(loaded.extents(), 1000 * SIZE_M, rtol=1e-5)
            self.assertEqual(loaded.colours.shape[1], 3)
        texture = cv2.imread(os.path.join(folder, "models", "obj_000001.png"))
        np.testing.assert_array_equal(texture, small_database.texture())

    def test_bop_numbers_stay(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        out = os.path.join(folder.name, "bop")
        command.export_objects(self.root, ["one"], "bop", out)
        command.export_objects(self.root, ["box"], "bop", out)
        for _ in range(2):
            with open(os.path.join(out, "object_ids.yaml")) as text:
                self.assertEqual(yaml.safe_load(text), {"one": 1, "box": 2})
            with open(os.path.join(out, "models", "models_info.json")) as text:
                self.assertEqual(sorted(json.load(text)), ["1", "2"])
            command.export_objects(self.root, [], "bop", out)
        self.assertEqual(sorted(os.listdir(os.path.join(out, "onboarding_static"))),
                         ["obj_000001_up", "obj_000002_down", "obj_000002_up"])

    def test_foundationpose(self):
        folder = os.path.join(self.export("foundationpose"), "box")
        pictures = sorted(glob.glob(os.path.join(folder, "rgb", "*.png")))
        self.assertEqual(len(pictures), 2 * VIEWS)
        for number, path in enumerate(pictures):
            name = os.path.basename(path)
            for depth, masks in (("depth", "masks"), ("depth_enhanced", "mask")):
                depth_m = cv2.imread(os.path.join(folder, depth, name), cv2.IMREAD_UNCHANGED) / 1000
                mask = cv2.imread(os.path.join(folder, masks, name), cv2.IMREAD_UNCHANGED)
                pose = np.loadtxt(os.path.join(folder, "cam_in_ob", name.replace("png", "txt")))
                self.assert_view(number, cv2.imread(path), depth_m, mask, np.loadtxt(os.path.join(folder, "K.txt")),
                                 np.linalg.inv(pose))
        loaded = loaders.Loaded(os.path.join(folder, "mesh", "textured.obj"))
        np.testing.assert_allclose(loaded.extents(), SIZE_M, rtol=1e-5)

    def test_v4r(self):
        """Names and content are those of the database."""
        folder = os.path.join(self.export("v4r"), "box")
        views = os.listdir(os.path.join(self.root, "box", "views"))
        for name in [os.path.join("views", view) for view in views] + ["3D_model.pcd"]:
            source = os.path.join(self.root, "box", name.replace("3D_model", "cloud"))
            with open(os.path.join(folder, name), "rb") as copy, open(source, "rb") as file:
                self.assertEqual(copy.read(), file.read(), name)

    def test_sessions_of_objects_of_before(self):
        """Their views say nothing; quality.yaml does."""
        with tempfile.TemporaryDirectory() as root:
            description = small_database.write_object(root, "old")
            for view in description["views"]:
                del view["session"]
            small_database.write_description(root, "old", description)
            sequences = os.path.join(root, "exports", "bop", "onboarding_static", "*")
            command.export_objects(root, [], "bop")
            self.assertEqual(len(glob.glob(sequences)), 1)  # nobody knows: one sequence
            views = [{"index": i, "session_id": "first" if i < VIEWS else "second"} for i in range(2 * VIEWS)]
            with open(os.path.join(root, "old", "quality.yaml"), "w") as text:
                yaml.safe_dump({"views": views}, text)
            command.export_objects(root, [], "bop")
            self.assertEqual([len(os.listdir(os.path.join(path, "rgb"))) for path in glob.glob(sequences)], [VIEWS] * 2)

    def test_what_a_format_cannot_hold_is_said(self):
        with tempfile.TemporaryDirectory() as root:
            description = small_database.write_object(root, "box", sessions=("first", "second", "third"))
            description["views"][0]["fx_px"] += 1.0
            axis = {"of": "texture", "kind": "continuous", "axis": [0, 0, 1], "point_m": [0.01, 0.0, 0.0], "order": 0}
            small_database.write_description(root, "box", dict(description, symmetries=[axis]))
            folder, notes = command.export_objects(root, [], "bop")
            self.assertEqual(len(notes), 1)
            self.assertIn("the views of session 'third' are left out", notes[0])
            with open(os.path.join(folder, "models", "models_info.json")) as text:
                info = json.load(text)["1"]
            self.assertEqual(info["symmetries_continuous"], [{"axis": [0, 0, 1], "offset": [10, 0, 0]}])
            folder, notes = command.export_objects(root, [], "foundationpose")
            self.assertEqual(len(os.listdir(os.path.join(folder, "box", "rgb"))), 3 * VIEWS - 1)
            self.assertIn("1 of 9 views are left out", notes[0])


if __name__ == "__main__":
    unittest.main()

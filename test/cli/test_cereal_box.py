"""The real recording end to end: a carton of about 70 x 200 x 300 mm on a turntable, 11.5 degrees a frame."""

import json
import os
import tempfile
import unittest

from command import CEREAL_BOX, run_json  # first: its output gives the next one's place

from carton import fold_thickness_m

KNOWN_SIZE_M = (0.070, 0.200, 0.300)


def model(database, *more):
    return run_json("model", "cereal_box", CEREAL_BOX, "--reference", "object", "--database", database, *more)


class CerealBoxTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.database = os.path.join(cls.folder.name, "database")
        cls.store = os.path.join(cls.folder.name, "store.sqlite")
        cls.result = model(cls.database, "--store", cls.store)

    def test_all_frames_are_placed(self):
        session = self.result["sessions"][0]
        self.assertEqual(session["frame_count"], 31)
        self.assertEqual(session["tracked_count"], 31)
        self.assertEqual(session["refinement"]["left_out"], [])

    def test_the_loop_closes(self):
        keyframes = [k["keyframe_id"] for k in self.result["sessions"][0]["refinement"]["keyframes"]]
        closing = [link for link in self.result["sessions"][0]["refinement"]["links"]
                   if (link["keyframe_a"], link["keyframe_b"]) == (min(keyframes), max(keyframes))]
        self.assertEqual(len(closing), 1, "the last keyframe was not linked to the first")
        self.assertLessEqual(closing[0]["translation_error_after_mm"], 10.0)
        self.assertLessEqual(closing[0]["rotation_error_after_deg"], 1.0)

    def test_size(self):
        thickness_m = fold_thickness_m(os.path.join(self.result["build"]["object_folder"], "mesh", "mesh.ply"))
        outer_m, width_m, height_m = sorted(self.result["build"]["size_m"])
        for measured, known in zip((thickness_m, width_m, height_m), KNOWN_SIZE_M):
            self.assertLessEqual(abs(measured - known), 0.04 * known, f"{measured} m instead of {known} m")
        # The large faces bulge by some millimetres each; a double wall would show here as well.
        self.assertLessEqual(outer_m - thickness_m, 0.012)

    def test_the_database_is_sound_and_complete(self):
        self.assertEqual(run_json("check", self.database)["problems"], [])
        folder = self.result["build"]["object_folder"]
        for name in ("object.yaml", "cloud.pcd", "mesh/mesh.ply", "mesh/mesh.obj", "mesh/textured.obj",
                     "mesh/textured.png", "mesh/textured.glb", "preview.png"):
            self.assertGreater(os.path.getsize(os.path.join(folder, name)), 100, name)

    def test_exports_are_made_beside_the_objects(self):
        for format_name, name in (("bop", "onboarding_static/obj_000001_up/scene_gt.json"),
                                  ("urdf", "cereal_box/cereal_box.urdf"), ("ply", "cereal_box/cereal_box.png")):
            folder = run_json("export", self.database, "--format", format_name)["folder"]
            self.assertEqual(folder, os.path.join(self.database, "exports", format_name))
            self.assertGreater(os.path.getsize(os.path.join(folder, name)), 100)
        with open(os.path.join(self.database, "exports", "bop", "onboarding_static", "obj_000001_up",
                               "scene_gt_info.json")) as text:
            fractions = [info[0]["visib_fract"] for info in json.load(text).values()]
        self.assertGreater(sorted(fractions)[len(fractions) // 2], 0.8)  # masks and poses fit each other
        self.assertEqual(run_json("check", self.database)["problems"], [])

    def test_the_store_keeps_the_session(self):
        sessions = run_json("info", self.store)["sessions"]
        self.assertEqual([s["object_id"] for s in sessions], ["cereal_box"])
        self.assertTrue(sessions[0]["closed"])

    def test_the_same_recording_gives_the_same_model(self):
        again = os.path.join(self.folder.name, "again")
        model(again)
        first, second = (run_json("info", path)["objects"][0]["content_hash"] for path in (self.database, again))
        self.assertEqual(first, second)


if __name__ == "__main__":
    unittest.main()

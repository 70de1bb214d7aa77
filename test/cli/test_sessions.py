"""Several sessions of one object in a store: one more is aligned with what is there, and a person's word stands."""

import json
import os
import sqlite3
import tempfile
import unittest

from command import HANDHELD, run, run_json

SAME_POSE = ("--same-pose-probability", "0.5")  # the same recording twice: the object was not turned over


class SessionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.store, cls.database = (os.path.join(cls.folder.name, name) for name in ("sessions.sqlite", "objects"))
        recordings = [os.path.join(cls.folder.name, name) for name in ("walk_1", "walk_2")]
        for recording in recordings:
            os.symlink(HANDHELD, recording)
        arguments = ("--store", cls.store, "--database", cls.database, *SAME_POSE)
        cls.first = run_json("model", "bottle", recordings[0], *arguments)
        cls.frame = cls.model_from_session("walk_1")
        cls.second = run_json("model", "bottle", recordings[1], *arguments)

    @classmethod
    def model_from_session(cls, session_id):
        with sqlite3.connect(cls.store) as store:
            row = store.execute("SELECT model_from_session FROM sessions WHERE session_id = ?", (session_id,)).fetchone()
        return [float(number) for number in row[0].split()]

    def align(self, *arguments):
        return run_json("align", "bottle", "--store", self.store, *SAME_POSE, *arguments)

    def test_one_more_session_joins_and_the_frame_stays(self):
        self.assertEqual(len(self.first["sessions"]), 1)
        self.assertNotIn("alignment", self.first)
        edge = self.second["alignment"]["edges"][0]
        self.assertTrue(edge["accepted"] and edge["used"])
        self.assertEqual(self.model_from_session("walk_1"), self.frame)
        # The same recording twice.
        for a, b in zip(self.model_from_session("walk_2"), self.frame):
            self.assertAlmostEqual(a, b, delta=0.003)

    def test_what_was_not_turned_over_is_not_joined_unasked(self):
        refused = run("align", "bottle", "--store", self.store, "--anew", "--quiet")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("not been turned over", refused.stderr)
        self.assertIn("--same-pose-probability", refused.stderr)
        self.assertTrue(self.align("--anew")["edges"][0]["accepted"])

    def test_what_was_not_refined_or_segmented_yet_is_so_first(self):
        copy = os.path.join(self.folder.name, "unrefined.sqlite")
        with sqlite3.connect(self.store) as store, sqlite3.connect(copy) as other:
            store.backup(other)
            other.execute("UPDATE sessions SET refined_by = '', segmented_by = '' WHERE session_id = 'walk_2'")
        places = ("--store", copy, "--database", os.path.join(self.folder.name, "other_objects"))
        answer = run_json("model", "bottle", *places, *SAME_POSE)
        self.assertEqual([session["session_id"] for session in answer["sessions"]], ["walk_2"])
        self.assertEqual(answer["sessions"][0]["refinement"]["status"]["code"], 0)
        self.assertTrue(answer["sessions"][0]["segmentation"]["support_plane_found"])
        self.assertEqual(answer["unchanged_sessions"], ["walk_1"])
        with sqlite3.connect(copy) as store:
            marks = store.execute("SELECT refined_by, segmented_by FROM sessions WHERE session_id = 'walk_2'").fetchone()
        self.assertEqual(marks, ("both", "automatic"))

    def test_builds_from_the_store_alone(self):
        again = run_json("model", "bottle", "--store", self.store, "--database", self.database, *SAME_POSE)
        self.assertEqual(again["sessions"], [])
        self.assertEqual(again["unchanged_sessions"], ["walk_1", "walk_2"])
        self.assertEqual(len(again["alignment"]["transforms"]), 1)
        refused = run("model", "mug", "--store", self.store, "--database", self.database)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("no session of object 'mug'", refused.stderr)
        refused = run("model", "mug", "--database", self.database)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("no recording", refused.stderr)

    def test_a_persons_word_stands(self):
        refused = run("align", "bottle", "--store", self.store, "--refuse", "walk_1", "walk_2")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("refused by a person", refused.stderr)
        refused = run("align", "bottle", "--store", self.store, "--anew", "--json", "--quiet")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("refused by a person", refused.stderr)
        answer = json.loads(refused.stdout)  # with every edge all the same
        self.assertIn("could not be aligned", answer["status"]["message"])
        self.assertEqual([edge["decision"] for edge in answer["edges"]], ["refused"])
        accepted = self.align("--accept", "walk_2", "walk_1")
        self.assertEqual(accepted["edges"][0]["decision"], "accepted")
        self.assertEqual(self.align("--forget", "walk_1", "walk_2")["edges"][0]["decision"], "automatic")
        refused = run("align", "bottle", "--store", self.store, "--accept", "walk_1", "walk_2", "--candidate", "77")
        self.assertIn("number 77", refused.stderr)


if __name__ == "__main__":
    unittest.main()

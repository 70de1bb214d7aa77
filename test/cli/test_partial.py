"""Recordings that do not fit each other: a partial object, which the printed commands make whole."""

import json
import os
import re
import tempfile
import unittest

from command import CEREAL_BOX, HANDHELD, run, run_json


def commands_in(text):
    """Arguments of the object_modelling commands that a message quotes."""
    return [quoted.split() for quoted in re.findall(r"'object_modelling ([^']*)'", text)]


class PartialTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.store, cls.database = (os.path.join(cls.folder.name, name) for name in ("sessions.sqlite", "objects"))
        cls.places = ("--store", cls.store, "--database", cls.database)
        # Two objects, taken for one.
        run_json("model", "odd", HANDHELD, *cls.places)
        cls.finished = run("model", "odd", CEREAL_BOX, "--reference", "object", *cls.places, "--json", "--quiet")

    def info(self):
        self.assertEqual(run_json("check", self.database)["problems"], [])
        return run_json("info", self.database)["objects"][0]

    def test_1_a_refused_pair_gives_a_partial_object(self):
        self.assertEqual(self.finished.returncode, 0, self.finished.stderr)
        answer = json.loads(self.finished.stdout)
        self.assertIs(answer["partial"], True)
        self.assertEqual(answer["left_out"], ["cereal_box_turntable"])
        self.assertEqual(len(answer["refused_pairs"]), 1)
        self.assertTrue(answer["refused_pairs"][0]["reason"])
        self.assertNotIn("joint refinement", answer["build"]["stage_s"])
        self.assertIn("WARNING: PARTIAL: object 'odd' is built from 1 of its 2 sessions, without 'cereal_box_turntable'",
                      self.finished.stderr)
        self.assertIn(answer["refused_pairs"][0]["reason"], self.finished.stderr)

        entry = self.info()
        self.assertIs(entry["partial"], True)
        self.assertEqual([left["session_id"] for left in entry["sessions_left_out"]], ["cereal_box_turntable"])
        with open(os.path.join(answer["build"]["object_folder"], "report.html"), encoding="utf-8") as report:
            self.assertIn('id="partial"', report.read())
        self.assertIn("PARTIAL", run("info", self.database).stdout)

    def test_2_an_error_on_request(self):
        strict = run("model", "odd", *self.places, "--require-all", "--json", "--quiet")
        self.assertEqual(strict.returncode, 1)
        answer = json.loads(strict.stdout)
        self.assertEqual(answer["status"]["code"], 5)
        self.assertEqual(len(answer["alignment"]["edges"]), 1)
        self.assertGreater(len(answer["alignment"]["edges"][0]["candidates"]), 0)
        self.assertIn("--accept", strict.stderr)

    def test_3_the_printed_commands_make_it_whole(self):
        align, model = commands_in(self.finished.stderr)
        self.assertIn("--accept", align)
        accepted = run_json(*align)
        self.assertEqual(accepted["edges"][0]["decision"], "accepted")
        whole = run(*model, "--require-all", "--json", "--quiet")
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertNotIn("PARTIAL", whole.stderr)
        answer = json.loads(whole.stdout)
        self.assertIs(answer["partial"], False)
        self.assertEqual(answer["left_out"], [])
        entry = self.info()
        self.assertIs(entry["partial"], False)
        self.assertEqual(len(entry["sessions"]), 2)


if __name__ == "__main__":
    unittest.main()

"""Help texts, exit codes, and error messages for bad input; no files are left behind."""

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest

from command import CEREAL_BOX, COMMAND, HANDHELD, run


class UsageTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def assert_refused(self, finished, *words, code=1):
        self.assertEqual(finished.returncode, code, finished.stderr)
        for word in words:
            self.assertIn(word, finished.stderr)

    def test_help_names_every_command(self):
        text = run("--help").stdout
        for word in ("track", "model", "align", "calibrate_noise", "calibrate_camera", "info", "compare", "report", "export",
                     "recognise", "import_mesh", "check", "migrate", "rename", "merge", "delete", "Exit codes"):
            self.assertIn(word, text)
        for command in ("track", "model", "align", "calibrate_noise", "calibrate_camera", "info", "compare", "report", "export",
                        "recognise", "import_mesh", "check", "migrate", "rename", "merge", "delete"):
            finished = run(command, "--help")
            self.assertEqual(finished.returncode, 0)
            self.assertGreater(len(finished.stdout.splitlines()), 5)

    def test_wrong_command_lines_exit_with_2(self):
        self.assert_refused(run(), code=2)
        self.assert_refused(run("tracc", CEREAL_BOX), code=2)
        self.assert_refused(run("track"), "recording", code=2)
        self.assert_refused(run("track", CEREAL_BOX, "--reference", "moon"), "reference", code=2)
        self.assert_refused(run("model", "box", CEREAL_BOX), "database", code=2)

        align = ("align", "box", "--store", self.path("no.sqlite"))
        self.assert_refused(run(*align, "--same-pose-probability", "2"), "same-pose-probability", code=2)
        self.assert_refused(run(*align, "--min-overlap", "-0.1"), "min-overlap", code=2)
        self.assert_refused(run(*align, "--rotations", "-1"), "rotations", code=2)

    def test_exports_that_cannot_be(self):
        database = self.path("objects")
        self.assert_refused(run("export", database), "format", code=2)
        self.assert_refused(run("export", database, "--format", "stl", "--unit", "inch"), "unit", code=2)
        self.assert_refused(run("export", database, "--format", "stl"), database, "manifest.yaml")
        self.assert_refused(run("export", database, "--format", "wrl"), "'wrl'", "bop")
        self.assertEqual(os.listdir(self.folder.name), [])
        listed = run("export", database, "--format", "list")
        self.assertEqual(listed.returncode, 0, listed.stderr)
        for word in ("bop", "urdf", "foundationpose"):
            self.assertIn(word, listed.stdout)
        failure = run("export", database, "--format", "stl", "--json")
        self.assertEqual(json.loads(failure.stdout)["status"]["code"], 2)

    def test_align_names_what_is_missing(self):
        store = self.path("typed_wrongly.sqlite")
        self.assert_refused(run("align", "mug", "--store", store), store)
        self.assertFalse(os.path.exists(store))
        self.assert_refused(run("align", "mug"), "store", code=2)

    def test_two_recordings_of_one_name_are_refused_before_any_work(self):
        twin = self.path("twin", os.path.basename(HANDHELD))
        os.makedirs(os.path.dirname(twin))
        os.symlink(HANDHELD, twin)
        finished = run("model", "box", HANDHELD, twin, "--database", self.path("objects"))
        self.assert_refused(finished, twin, os.path.basename(HANDHELD), "rename")
        self.assertNotIn("track", finished.stderr.split("recording '")[0])

    def test_missing_and_foreign_recordings(self):
        missing = self.path("nowhere")
        self.assert_refused(run("track", missing), missing)
        self.assert_refused(run("track", self.folder.name), self.folder.name, "camera.yaml")
        with open(self.path("notes.txt"), "w") as notes:
            notes.write("not a recording")
        self.assert_refused(run("track", self.path("notes.txt")), "notes.txt")
        with open(self.path("broken.bag"), "w") as bag:
            bag.write("#ROSBAG V2.0\nrubbish")
        self.assert_refused(run("track", self.path("broken.bag")), "broken.bag")

    def test_a_failure_is_json_too(self):
        finished = run("track", self.path("nowhere"), "--json")
        self.assertEqual(finished.returncode, 1)
        status = json.loads(finished.stdout)["status"]
        self.assertEqual(status["code"], 2)
        self.assertIn("nowhere", status["message"])

    def test_unwritable_database_is_refused_before_any_work(self):
        with open(self.path("file"), "w") as blocker:
            blocker.write("in the way")
        start = time.monotonic()
        finished = run("model", "box", HANDHELD, "--database", self.path("file", "database"))
        self.assert_refused(finished, "file")
        self.assertLess(time.monotonic() - start, 5)

    def test_hostile_object_id(self):
        finished = run("model", "../evil", CEREAL_BOX, "--database", self.path("database"), "--reference", "object")
        self.assert_refused(finished, "../evil")
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["database"])

    def test_report_of_nothing(self):
        self.assert_refused(run("report", "box", "--database", self.path("database")), "database")
        os.mkdir(self.path("database"))
        with open(self.path("database", "manifest.yaml"), "w") as manifest:
            manifest.write("schema_version: 1\nunit: metre\nhandedness: right\nobjects: []\n")
        self.assert_refused(run("report", "box", "--database", self.path("database")), "'box' is not in")
        self.assert_refused(run("report", "../box", "--database", self.path("database")), "../box")

    def test_info_on_nothing_creates_nothing(self):
        self.assert_refused(run("info", self.path("store.sqlite")), "store.sqlite")
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_interrupt_leaves_no_session_behind(self):
        store = self.path("store.sqlite")
        process = subprocess.Popen([COMMAND, "model", "bottle", HANDHELD, "--database", self.path("database"),
                                    "--store", store], stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                                   universal_newlines=True)
        deadline = time.monotonic() + 60
        while not os.path.exists(store) and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("cancelled", errors)
        self.assertIn("0 session(s)", run("info", store).stdout)


if __name__ == "__main__":
    unittest.main()

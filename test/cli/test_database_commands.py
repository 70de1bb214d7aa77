"""Objects made of meshes, and what is done with a database: check, rename, delete, migrate."""

import os
import tempfile
import unittest

from command import run, run_json

BOX_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def write_box(path, size):
    x, y, z = size
    corners = [(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0), (0, 0, z), (x, 0, z), (x, y, z), (0, y, z)]
    with open(path, "w") as file:
        file.writelines("v %f %f %f\n" % corner for corner in corners)
        file.writelines("f %s\n" % " ".join(str(corner + 1) for corner in face) for face in BOX_FACES)


class DatabaseCommandsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.mesh = self.path("box.obj")
        self.database = self.path("objects")
        write_box(self.mesh, (120, 80, 40))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def assert_refused(self, finished, *words):
        self.assertEqual(finished.returncode, 1, finished.stderr)
        for word in words:
            self.assertIn(word, finished.stderr)

    def test_a_mesh_becomes_an_object(self):
        answer = run_json("import_mesh", self.mesh, self.database, "--id", "box", "--name", "A box")
        self.assertEqual(answer["unit_m"], 0.001)
        for edge, expected in zip(answer["size_m"], (0.12, 0.08, 0.04)):
            self.assertAlmostEqual(edge, expected, places=4)
        self.assertIn("2-fold", answer["properties"])
        self.assertEqual(run_json("check", self.database)["problems"], [])
        text = run("info", self.database).stdout
        self.assertIn("volume 384 ml", text)
        self.assertIn("check", text)
        self.assert_refused(run("import_mesh", self.mesh, self.database, "--id", "box"), "'box'", "replace")

        self.assert_refused(run("report", "box", "--database", self.database), "quality.yaml", "imported from a mesh")
        again = run_json("import_mesh", self.mesh, self.database, "--id", "box", "--replace")
        self.assertEqual(again["object_id"], "box")
        self.assertEqual(run_json("info", self.database)["objects"][0]["frame_version"], 2)

        os.makedirs(self.path("objects", "exports", "stl", "box"))
        renamed = run("rename", self.database, "box", "carton")
        self.assertEqual(renamed.returncode, 0, renamed.stderr)
        self.assertIn("--format stl", renamed.stderr)
        self.assertIn("--store", renamed.stdout)
        self.assert_refused(run("rename", self.database, "carton", "box", "--store", self.path("none.db")), "none.db")
        self.assertEqual(run_json("check", self.database)["problems"], [])
        self.assert_refused(run("rename", self.database, "box", "else"), "'box'")
        self.assertEqual([found["id"] for found in run_json("info", self.database)["objects"]], ["carton"])
        self.assertIn("carton: up to date", run("migrate", self.database).stdout)

        with open(os.path.join(self.database, "carton", "cloud.pcd"), "ab") as cloud:
            cloud.write(b"x")
        broken = run("check", self.database)
        self.assert_refused(broken, "1 problem(s)")
        self.assertIn("PROBLEM", broken.stdout)
        self.assertIn("cloud.pcd has been changed", broken.stdout)

        self.assertEqual(run("delete", self.database, "carton").returncode, 0)
        self.assertEqual(run_json("info", self.database)["objects"], [])
        self.assert_refused(run("delete", self.database, "carton"), "'carton'")

    def test_a_unit_that_is_not_clear_is_asked_for(self):
        write_box(self.mesh, (3, 2, 1))
        self.assert_refused(run("import_mesh", self.mesh, self.database, "--id", "box"), "--unit")
        answer = run_json("import_mesh", self.mesh, self.database, "--id", "box", "--unit", "mm")
        self.assertAlmostEqual(answer["size_m"][0], 0.003, places=5)

    def test_a_newer_database_is_left_alone(self):
        os.mkdir(self.database)
        manifest = os.path.join(self.database, "manifest.yaml")
        text = "schema_version: 99\nunit: metre\nhandedness: right\nobjects: []\n"
        with open(manifest, "w") as file:
            file.write(text)
        for command in (("check", self.database), ("migrate", self.database), ("delete", self.database, "box"),
                        ("import_mesh", self.mesh, self.database, "--id", "box")):
            self.assert_refused(run(*command), "schema version 99")
        with open(manifest) as file:
            self.assertEqual(file.read(), text)

    def test_what_is_no_mesh(self):
        with open(self.path("notes.stl"), "w") as notes:
            notes.write("not a mesh")
        self.assert_refused(run("import_mesh", self.path("notes.stl"), self.database, "--id", "box"), "notes.stl")
        self.assert_refused(run("import_mesh", self.path("none.obj"), self.database, "--id", "box"), "none.obj")


if __name__ == "__main__":
    unittest.main()

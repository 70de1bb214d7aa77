"""An export appears whole or not at all, and what is wrong with a call is told."""
import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from unittest import mock

import small_database
import yaml
from object_modelling import exporters
from object_modelling.exporters import command, files, stl
from object_modelling.outcome import Code, Failure


class CommandTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = os.path.join(folder.name, "objects")
        os.mkdir(cls.root)
        for object_id in ("a", "b"):
            small_database.write_object(cls.root, object_id, sessions=("one",))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = os.path.join(folder.name, "new", "out")

    def refused(self, code, *words, root=None, ids=(), format_name="stl", **more):
        with self.assertRaises(Failure) as raised:
            command.export_objects(root or self.root, ids, format_name, more.pop("out", self.out), **more)
        self.assertEqual(raised.exception.code, code, raised.exception.message)
        for word in words:
            self.assertIn(word, raised.exception.message)
        self.assertFalse(os.path.exists(os.path.dirname(self.out)))

    def contents(self):
        found = {}
        for parent, folders, names in os.walk(self.out):
            self.assertFalse([name for name in folders if name.startswith(files.PREFIX)])
            for name in names:
                with open(os.path.join(parent, name), "rb") as file:
                    found[os.path.relpath(os.path.join(parent, name), self.out)] = file.read()
        return found

    def test_bad_calls(self):
        self.refused(Code.INVALID_ARGUMENT, "'wrl'", "bop", "urdf", format_name="wrl")
        self.refused(Code.NOT_FOUND, "'c'", "'a', 'b'", self.root, ids=["a", "c"])
        self.refused(Code.INVALID_ARGUMENT, "'inch'", "mm", unit="inch")
        self.refused(Code.INVALID_ARGUMENT, "'urdf'", "fixed", format_name="urdf", unit="mm")
        self.refused(Code.NOT_FOUND, "/nowhere", "manifest.yaml", root="/nowhere")
        with tempfile.TemporaryDirectory() as empty:
            small_database.write_manifest(empty)
            self.refused(Code.FAILED_PRECONDITION, "no objects", "build", root=empty)

    def test_folders_that_cannot_be_used(self):
        self.refused(Code.STORAGE, "/proc/x", "writable", out="/proc/x")
        self.refused(Code.INVALID_ARGUMENT, "object database", out=self.root)
        os.makedirs(os.path.join(self.out, "a"))
        foreign = os.path.join(self.out, "a", "notes.txt")
        with open(foreign, "w") as text:
            text.write("mine")
        with self.assertRaisesRegex(Failure, "out/a' holds files that no export has made"):
            command.export_objects(self.root, [], "stl", self.out)
        self.assertEqual(self.contents(), {"a/notes.txt": b"mine"})

    def test_default_folder_and_all_objects(self):
        folder, notes = command.export_objects(self.root, [], "stl")
        self.assertEqual((folder, notes), (os.path.join(self.root, "exports", "stl"), []))
        self.assertEqual(sorted(os.listdir(folder)), ["a", "b"])
        with open(os.path.join(folder, "a", "export.yaml")) as text:
            self.assertEqual(yaml.safe_load(text)["format"], "stl")

    def test_the_same_bytes_again(self):
        for format_name in exporters.FORMATS:
            self.out = os.path.join(os.path.dirname(self.out), format_name)
            command.export_objects(self.root, [], format_name, self.out)
            before = self.contents()
            command.export_objects(self.root, [], format_name, self.out)
            self.assertEqual(self.contents(), before)
            command.export_objects(self.root, ["b"], format_name, self.out)
            self.assertEqual(self.contents(), before)

    def test_a_failure_leaves_what_was_there(self):
        for format_name, module in (("stl", stl), ("bop", exporters.FORMATS["bop"])):
            self.out = os.path.join(os.path.dirname(self.out), format_name)
            command.export_objects(self.root, ["a"], format_name, self.out)
            before, write = self.contents(), module.export
            for error in (OSError(28, "No space left on device"), KeyError("size_m"), KeyboardInterrupt()):
                def broken(model, folder, error=error, **more):
                    write(model, folder, **more)
                    if model.id == "b":
                        raise error
                expected = KeyboardInterrupt if isinstance(error, KeyboardInterrupt) else Failure
                with mock.patch.object(module, "export", broken), self.assertRaises(expected):
                    command.export_objects(self.root, [], format_name, self.out)
                self.assertEqual(self.contents(), before)

    def test_damaged_objects_are_named(self):
        with tempfile.TemporaryDirectory() as root:
            small_database.write_object(root, "a", sessions=("one",))
            os.remove(os.path.join(root, "a", "mesh", "mesh.ply"))
            self.refused(Code.NOT_FOUND, "mesh.ply", "build the object anew", root=root)
            os.truncate(os.path.join(root, "a", "views", "cloud_00000001.pcd"), 1000)
            self.refused(Code.BAD_INPUT, "cloud_00000001.pcd", root=root, format_name="foundationpose")
            with open(os.path.join(root, "a", "object.yaml"), "a") as text:
                text.write("more: 1\n")
            self.refused(Code.FAILED_PRECONDITION, "object.yaml", "manifest.yaml", root=root, format_name="v4r")

    def test_newer_schemas_are_refused(self):
        with tempfile.TemporaryDirectory() as root:
            description = small_database.write_object(root, "a", sessions=("one",))
            small_database.write_description(root, "a", dict(description, schema_version=9))
            self.refused(Code.STORAGE, "schema version 9", root=root)

    def test_what_a_killed_export_left_is_removed(self):
        os.makedirs(os.path.join(self.out, files.PREFIX + "dead"))
        command.export_objects(self.root, [], "stl", self.out)
        self.assertEqual(sorted(os.listdir(self.out)), ["a", "b"])

    def test_two_at_once_do_not_disturb_each_other(self):
        errors = []

        def export():
            try:
                command.export_objects(self.root, [], "stl", self.out)
            except Failure as failure:
                errors.append(failure)
        threads = [threading.Thread(target=export) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(errors, [])
        self.assertEqual(sorted(os.listdir(self.out)), ["a", "b"])

    def test_interrupted_from_outside(self):
        slow = ("import sys, time; from object_modelling.exporters import command, stl; inner = stl.export\n"
                "def export(model, folder):\n  inner(model, folder); print('going', flush=True); time.sleep(60)\n"
                "stl.export = export; sys.exit(command.main(sys.argv[1:]))")
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([sys.executable, "-c", slow, self.root, "--format", "stl", "--out", self.out],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
            self.assertEqual(process.stdout.readline(), "going\n")
            process.send_signal(number)
            errors = process.communicate(timeout=30)[1]
            self.assertEqual(process.returncode, 10 + Code.CANCELLED, errors)
            self.assertFalse(os.path.exists(os.path.dirname(self.out)))

    def test_main(self):
        def main(*arguments):
            output, errors = io.StringIO(), io.StringIO()
            with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors), \
                    mock.patch.object(command.signal, "signal"):
                return command.main(arguments), output.getvalue(), errors.getvalue()
        code, output, _ = main(self.root, "--format", "list")
        self.assertEqual((code, len(output.splitlines())), (0, len(exporters.FORMATS)))
        code, output, _ = main(self.root, "--format", "stl", "--id", "a", "--out", self.out, "--json")
        self.assertEqual((code, json.loads(output)["folder"], os.listdir(self.out)), (0, self.out, ["a"]))
        code, output, errors = main(self.root, "--format", "stl", "--id", "z")
        self.assertEqual((code, output), (10 + Code.NOT_FOUND, ""))
        self.assertRegex(errors, r"^export_objects: database '.*' has no object 'z': it has 'a', 'b'\n$")


if __name__ == "__main__":
    unittest.main()

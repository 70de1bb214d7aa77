#!/usr/bin/python3
"""The node's service writes objects, and says what is wrong with a call."""
import os
import shutil
import subprocess
import sys
import unittest

import roslib.packages
import rospy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exporters"))
# pylint: disable=wrong-import-position
import small_database
from object_modelling import srv
from object_modelling.outcome import Code


class ExporterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = rospy.get_param("exporter/database_path")
        shutil.rmtree(os.path.dirname(cls.root), ignore_errors=True)
        rospy.wait_for_service("exporter/export", 30)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(os.path.dirname(cls.root), ignore_errors=True)

    @staticmethod
    def export(*object_ids, format_name="stl", folder=""):
        call = rospy.ServiceProxy("exporter/export", srv.ExportObjects)
        return call(object_ids=object_ids, format=format_name, folder=folder)

    def refused(self, code, word, *object_ids, **more):
        status = self.export(*object_ids, **more).status
        self.assertEqual(status.code, code, status.message)
        self.assertIn(word, status.message)

    def test_exports(self):
        self.refused(Code.NOT_FOUND, "manifest.yaml")  # nothing has been built yet
        os.makedirs(self.root)
        small_database.write_manifest(self.root)
        self.refused(Code.FAILED_PRECONDITION, "no objects")
        for object_id in ("a", "b"):
            small_database.write_object(self.root, object_id, sessions=("one",))
        answer = self.export("a")
        self.assertEqual(answer.status.code, Code.OK, answer.status.message)
        self.assertEqual(answer.folder, os.path.join(self.root, "exports", "stl"))
        self.assertEqual(os.listdir(answer.folder), ["a"])
        elsewhere = os.path.join(os.path.dirname(self.root), "elsewhere")
        answer = self.export(format_name="urdf", folder=elsewhere)
        self.assertEqual((answer.status.code, sorted(os.listdir(elsewhere))), (Code.OK, ["a", "b"]))
        self.refused(Code.NOT_FOUND, "'c'", "c")
        self.refused(Code.INVALID_ARGUMENT, "'wrl'", format_name="wrl")

    def test_wrong_parameters_end_the_node(self):
        program = roslib.packages.find_node("object_modelling", "exporter")[0]
        finished = subprocess.run([program, "__name:=wrong", "_databse_path:=x", "_database_path:=3"], timeout=60,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(finished.returncode, 1, finished.stdout)
        self.assertIn("~databse_path is not known", finished.stdout)
        self.assertIn("~database_path must be text", finished.stdout)


if __name__ == "__main__":
    import rostest
    rospy.init_node("test_exporter")
    rostest.rosrun("object_modelling", "test_exporter", ExporterTest)

#!/usr/bin/python3
"""The real recording that ships, from topics to the object database, by the driver that ./demo.sh uses."""
import contextlib
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rospkg
import rospy

from object_modelling import demo, msg, srv
from object_modelling.outcome import Code

TESTS = os.path.join(rospkg.RosPack().get_path("object_modelling"), "test")
sys.path.insert(0, os.path.join(TESTS, "support"))
from carton import fold_thickness_m  # noqa: E402  (found through the line above)

RECORDING = os.path.join(TESTS, "data", "cereal_box_turntable")
FRAME_COUNT = 31
SIZE_M = (0.300, 0.200, 0.070)
TOLERANCE_RATIO = 0.04
MANAGER = "/object_modelling/modelling_manager/"


def copy_store(source, target):
    """A SQLite store that another process has open, as it is now."""
    with contextlib.closing(sqlite3.connect(source)) as store, contextlib.closing(sqlite3.connect(target)) as copy:
        store.backup(copy)


def model_by_command(folder, object_id, *options):
    """Output of the command for the object that it makes of a copied store and database."""
    finished = subprocess.run(
        [roslib.packages.find_node("object_modelling", "object_modelling")[0], "model", object_id,
         "--store", os.path.join(folder, "store"), "--database", os.path.join(folder, "objects"), "--json", "--quiet",
         *options],
        universal_newlines=True, timeout=120, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if finished.returncode != 0:
        raise AssertionError("exit code %d: %s" % (finished.returncode, finished.stderr + finished.stdout[-1000:]))
    return json.loads(finished.stdout)


def call(name, service_type, **fields):
    return rospy.ServiceProxy(MANAGER + name, service_type)(**fields)


class EndToEndTest(unittest.TestCase):
    def test_cereal_box(self):
        lines = []
        options = demo.parse([RECORDING, "--object-id", "cereal_box", "--session-id", "box_1", "--timeout", "240"])
        built = demo.Demo(options, lines.append).run()

        tracked = [line for line in lines if "tracked" in line]
        self.assertIn("%d frames, %d of them tracked" % (FRAME_COUNT, FRAME_COUNT), tracked[0])
        # The carton's large faces bulge: its thickness is that of the folds.
        size = sorted((built.size_m.x, built.size_m.y, built.size_m.z), reverse=True)[:2]
        size.append(fold_thickness_m(built.mesh_path))
        for measured, true in zip(size, SIZE_M):
            self.assertLess(abs(measured - true), TOLERANCE_RATIO * true, "size %s" % (size,))
        for path in (built.object_folder, built.mesh_path, built.preview_path):
            self.assertTrue(os.path.exists(path), path)
        stages = [stage.stage for stage in built.stages]
        self.assertEqual(stages, ["refine", "segment", "align", "load", "fuse", "surface", "texture", "properties",
                                  "describe", "write", "report"])
        self.assertIn("preview", lines[-1])

        objects = call("list_objects", srv.ListObjects)
        self.assertEqual([entry.object_id for entry in objects.objects], ["cereal_box"])
        self.assertEqual(objects.objects[0].session_ids, ["box_1"])

        self.check_that_the_command_makes_the_same(objects)

        # After all that, wrong orders are still refused, and nothing needs a restart.
        self.assertEqual(call("stop_session", srv.StopSession).status.code, Code.FAILED_PRECONDITION)
        self.assertEqual(call("start_session", srv.StartSession, session_id="box_1").status.code,
                         Code.FAILED_PRECONDITION)
        self.assertEqual(call("start_session", srv.StartSession, session_id="box_2").status.code, Code.OK)
        self.assertEqual(call("discard_session", srv.DiscardSession).session_id, "box_2")

    def check_that_the_command_makes_the_same(self, objects):
        """Bit for bit, of the same sessions with the same options: once as they are, once through all stages again."""
        store = rospy.wait_for_message("/object_modelling/keyframe_store/state", msg.StoreState, 10).store
        for again in (False, True):
            with tempfile.TemporaryDirectory() as folder:
                copy_store(store, os.path.join(folder, "store"))
                shutil.copytree(objects.database_path, os.path.join(folder, "objects"))
                built = call("build_object", srv.BuildObject, object_id="cereal_box", again=again, wait=True)
                self.assertEqual(built.status.code, Code.OK, built.status.message)
                by_nodes = call("list_objects", srv.ListObjects).objects[0].content_hash
                answer = model_by_command(folder, "cereal_box", *(["--again"] if again else []))
                self.assertEqual(answer["unchanged_sessions"], [] if again else ["box_1"])
                self.assertEqual([session["session_id"] for session in answer["sessions"]], ["box_1"] if again else [])
                with open(os.path.join(folder, "objects", "manifest.yaml"), encoding="utf-8") as manifest:
                    self.assertIn(by_nodes, manifest.read(), "again: %s" % again)


if __name__ == "__main__":
    import rostest

    rospy.init_node("test_end_to_end")
    rostest.rosrun("object_modelling", "test_end_to_end", EndToEndTest)

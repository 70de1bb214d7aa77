#!/usr/bin/python3
"""The real recording that ships, from topics to the object database, by the driver that ./demo.sh uses."""
import os
import sys
import unittest

import rospkg
import rospy

from object_modelling import demo, srv
from object_modelling.outcome import Code

TESTS = os.path.join(rospkg.RosPack().get_path("object_modelling"), "test")
sys.path.insert(0, os.path.join(TESTS, "support"))
from carton import fold_thickness_m  # noqa: E402  (found through the line above)

RECORDING = os.path.join(TESTS, "data", "cereal_box_turntable")
FRAME_COUNT = 31
SIZE_M = (0.300, 0.200, 0.070)
TOLERANCE_RATIO = 0.04
MANAGER = "/object_modelling/modelling_manager/"


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
        self.assertEqual(stages, ["refine", "segment", "align", "load", "fuse", "surface", "texture", "describe", "write",
                                  "report"])
        self.assertIn("preview", lines[-1])

        objects = call("list_objects", srv.ListObjects)
        self.assertEqual([entry.object_id for entry in objects.objects], ["cereal_box"])
        self.assertEqual(objects.objects[0].session_ids, ["box_1"])

        # After all that, wrong orders are still refused, and nothing needs a restart.
        self.assertEqual(call("stop_session", srv.StopSession).status.code, Code.FAILED_PRECONDITION)
        self.assertEqual(call("start_session", srv.StartSession, session_id="box_1").status.code,
                         Code.FAILED_PRECONDITION)
        self.assertEqual(call("start_session", srv.StartSession, session_id="box_2").status.code, Code.OK)
        self.assertEqual(call("discard_session", srv.DiscardSession).session_id, "box_2")


if __name__ == "__main__":
    import rostest

    rospy.init_node("test_end_to_end")
    rostest.rosrun("object_modelling", "test_end_to_end", EndToEndTest)

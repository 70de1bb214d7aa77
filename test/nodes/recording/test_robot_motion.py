#!/usr/bin/python3
"""camera_tracker with a camera that is held by a robot, which publishes its pose on tf."""
import os
import sys
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support")]
# pylint: disable=wrong-import-position
from node_process import NodeProcess
from synthetic_camera import StepwiseScene, SyntheticCamera
from tracker_services import TRACKED, Tracker
from waiting import listen, wait_until
from object_modelling.msg import Status


class RobotMotionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.broadcaster = tf2_ros.TransformBroadcaster()
        cls.static_broadcaster = tf2_ros.StaticTransformBroadcaster()

    def transform(self, parent, child, stamp, translation, rotation_z_rad=0.0):
        message = TransformStamped()
        message.header.frame_id, message.child_frame_id, message.header.stamp = parent, child, stamp
        message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = translation
        message.transform.rotation.z, message.transform.rotation.w = np.sin(rotation_z_rad / 2), np.cos(
            rotation_z_rad / 2)
        return message

    def run_steps(self, namespace, with_tf):
        """Error of the last position (m), None where lost, and the states."""
        random = np.random.RandomState(5)
        camera = SyntheticCamera(namespace, namespace + "_optical", scene=StepwiseScene())
        camera.stamp = rospy.Time(2000)
        tracker = Tracker(namespace)
        camera.wait_for_listeners()
        poses = []
        subscriber = listen(namespace + "/camera_tracker/pose", PoseWithCovarianceStamped, poses.append)
        self.assertEqual(tracker.start(session_id="steps").status.code, Status.OK)
        states = []
        for index in range(21):
            _, centre = StepwiseScene.world_from_camera(index)
            stamp = camera.send(index)
            if with_tf:  # noise of 1 mm and 0.1 degrees, and later than the image
                self.broadcaster.sendTransform(
                    self.transform("arm_base", camera.frame_id, stamp,
                                   np.array([0.3, -0.2, 0.9]) + centre + 0.001 * random.randn(3),
                                   0.0017 * random.randn()))
            states.append(camera.wait_for_state(lambda s, stamp=stamp: s.header.stamp == stamp))
        tracker.reset()
        if states[-1].status in TRACKED:
            wait_until(lambda: poses and poses[-1].header.stamp == stamp, "the pose of the last frame")
        subscriber.unregister()
        if states[-1].status not in TRACKED:
            return None, states
        return abs(poses[-1].pose.pose.position.x - centre[0]), states

    def test_motion_of_the_robot_counts(self):
        error_m, states = self.run_steps("robot", with_tf=True)
        self.assertTrue(all(s.status in TRACKED and s.robot_motion_used for s in states),
                        [(s.status, s.robot_motion_used, s.reason) for s in states])
        self.assertLess(error_m, 0.005)

        error_m, states = self.run_steps("no_robot", with_tf=False)
        self.assertFalse(any(s.robot_motion_used for s in states))
        self.assertTrue(error_m is None or error_m > 0.03, "without the robot the error is only %s m" % error_m)

    def test_missing_tf_is_said_once_and_does_no_harm(self):
        camera = SyntheticCamera("robot", "nobodys_optical")
        tracker = Tracker("robot")
        camera.wait_for_listeners()
        self.assertEqual(tracker.start(session_id="missing").status.code, Status.OK)
        states = [camera.track(index) for index in range(8)]
        self.assertTrue(all(s.status in TRACKED and not s.robot_motion_used for s in states))
        self.assertIn("arm_base", states[0].reason)
        self.assertFalse(any("arm_base" in s.reason for s in states[1:]), [s.reason for s in states])
        self.assertTrue(all(s.input_ok for s in states))
        tracker.reset()

    def test_frame_below_the_session_is_refused(self):
        self.static_broadcaster.sendTransform(
            self.transform("below_session", "on_the_table", rospy.Time(0), (0.1, 0, 0)))
        camera = SyntheticCamera("below", "below_optical")
        tracker = Tracker("below")
        camera.wait_for_listeners()
        self.assertEqual(tracker.start(session_id="below").status.code, Status.OK)
        states = [camera.track(index) for index in range(12)]
        self.assertTrue(all(s.status in TRACKED and not s.robot_motion_used for s in states))
        self.assertEqual(sum("hangs below 'below_session'" in s.reason for s in states), 1, [s.reason for s in states])
        tracker.reset()

    def test_robot_frames_that_cannot_be(self):
        for parameters, expected in (
                ({"robot/frame_id": "session"}, "must not be session_frame_id"),
                ({"robot/frame_id": "/base"}, "leading slash"),
                ({"robot/frame_id": "base", "tf_direction": "camera_below_session"}, "camera hangs below the robot"),
                ({"robot/frame_id": "base", "robot/translation_sigma_m": -1.0}, "robot_translation_sigma_m")):
            rospy.set_param("confused", {})
            for key, value in parameters.items():
                rospy.set_param("confused/" + key, value)
            code, output = NodeProcess("camera_tracker", "__name:=confused").wait()
            self.assertEqual(code, 1, parameters)
            self.assertIn(expected, output)
            rospy.delete_param("confused")


if __name__ == "__main__":
    rospy.init_node("test_robot_motion")
    rostest.rosrun("object_modelling", "test_robot_motion", "__main__")

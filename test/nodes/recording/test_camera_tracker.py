#!/usr/bin/python3
"""camera_tracker over its real topics and services: good runs, every bad input, wrong orders, resuming, two systems
side by side."""
import os
import signal
import sys
import threading
import time
import unittest
import xmlrpc.client

import numpy as np
import rosgraph
import rosnode
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped
from sensor_msgs.msg import Image

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support")]
# pylint: disable=wrong-import-position
from node_process import NodeProcess
from synthetic_camera import SCENE, SyntheticCamera
from tracker_services import TRACKED, Tracker
from waiting import listen, wait_until
from object_modelling import srv
from object_modelling.msg import Keyframe, Status, TrackingState

def get_session(namespace, session_id):
    rospy.wait_for_service(namespace + "/keyframe_store/get_session", 20)
    return rospy.ServiceProxy(namespace + "/keyframe_store/get_session", srv.GetSession)(session_id)


class CameraTrackerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.camera = SyntheticCamera("left", "left_optical")
        cls.tracker = Tracker("left")
        cls.camera.wait_for_listeners()
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)

    def setUp(self):
        self.tracker.reset()
        self.camera.states = []

    def start(self, session_id, **more):
        response = self.tracker.start(session_id=session_id, **more)
        self.assertEqual(response.status.code, Status.OK, response.status.message)
        return response.session_id

    def test_good_run(self):
        poses, keyframes = {}, []
        subscribers = [
            listen("left/camera_tracker/pose", PoseWithCovarianceStamped,
                   lambda pose: poses.update({pose.header.stamp: pose})),
            listen("left/camera_tracker/keyframe", Keyframe, keyframes.append),
        ]
        self.start("good", object_id="mug")
        stamps = []
        for index in range(45):
            state = self.camera.track(index)
            self.assertIn(state.status, TRACKED, "frame %d: %s" % (index, state.reason))
            self.assertTrue(state.input_ok and state.recording)
            self.assertEqual(state.session_id, "good")
            stamps.append(state.header.stamp)
        self.assertEqual((state.frame_count, state.tracked_count, state.dropped_frames), (45, 45, 0))
        self.assertGreaterEqual(state.keyframe_count, 2)

        ended = self.tracker.stop()
        self.assertEqual(ended.status.code, Status.OK, ended.status.message)
        self.assertEqual((ended.session_id, ended.frame_count), ("good", 45))
        wait_until(lambda: len(poses) >= 45 and len(keyframes) >= ended.keyframe_count, "45 poses and all keyframes")
        self.assertEqual(sorted(poses), stamps)
        pose = poses[stamps[-1]]
        self.assertEqual(pose.header.frame_id, "left_session")
        _, centre = SCENE.world_from_camera(44)
        position = pose.pose.pose.position
        error = np.linalg.norm(np.array([position.x, position.y, position.z]) - centre)
        self.assertLess(error, 0.005, "position is off by %.4f m" % error)

        # tf hangs the session below the camera: the inverse of the pose.
        transform = self.buffer.lookup_transform("left_session", "left_optical", stamps[-1],
                                                 rospy.Duration(2)).transform
        self.assertAlmostEqual(transform.translation.x, position.x, 6)

        stored = get_session("left", "good")
        self.assertEqual(stored.status.code, Status.OK)
        self.assertTrue(stored.session.closed)
        self.assertEqual(stored.session.object_id, "mug")
        self.assertEqual(stored.session.camera_frame_id, "left_optical")
        self.assertEqual(list(stored.keyframe_ids), [k.keyframe_id for k in keyframes])
        self.assertEqual(stored.session.started, stamps[0])
        for subscriber in subscribers:
            subscriber.unregister()

    def test_wrong_order(self):
        response = self.tracker.stop()
        self.assertEqual(response.status.code, Status.FAILED_PRECONDITION)
        self.assertIn("start", response.status.message)
        self.start("order")
        response = self.tracker.start(session_id="other")
        self.assertEqual(response.status.code, Status.FAILED_PRECONDITION)
        self.assertIn("'order'", response.status.message)
        self.camera.track(0)
        response = self.tracker.reset()
        self.assertEqual((response.status.code, response.session_id), (Status.OK, "order"))
        self.assertEqual(self.tracker.reset().session_id, "")

    def test_ids(self):
        for bad in ("../x", "a b", "-x", "x" * 65):
            self.assertEqual(self.tracker.start(session_id=bad).status.code, Status.INVALID_ARGUMENT, bad)
        self.camera.track(0)
        first = self.start("")
        self.assertRegex(first, r"^session_\d{8}_\d{6}_\d{3}")
        self.camera.track(0)
        self.tracker.stop()
        response = self.tracker.start(session_id=first)
        self.assertEqual(response.status.code, Status.FAILED_PRECONDITION)
        self.assertIn(first, response.status.message)

    def test_resume(self):
        self.start("resumed")
        for index in range(3):
            self.camera.track(index)
        self.tracker.stop()
        before = get_session("left", "resumed")
        self.assertEqual(self.tracker.start(session_id="nobody", resume=True).status.code, Status.NOT_FOUND)
        before.session.refinement_report = "of the keyframes so far"
        before.session.has_support_plane = True
        before.session.support_plane.normal.z = 1
        before.session.refined.by = before.session.segmented.by = "unknown"
        update = rospy.ServiceProxy("left/keyframe_store/update_session", srv.UpdateSession)
        self.assertEqual(update(before.session).status.code, Status.OK)
        self.start("resumed", resume=True)
        again = get_session("left", "resumed").session
        self.assertFalse(again.closed or again.has_support_plane or again.refinement_report)
        self.assertFalse(again.refined.by or again.segmented.by)
        states = [self.camera.track(index) for index in range(1, 45)]
        self.assertIn(states[-1].status, TRACKED, states[-1].reason)
        ended = self.tracker.stop()
        self.assertEqual(ended.status.code, Status.OK, ended.status.message)
        after = get_session("left", "resumed")
        self.assertGreater(len(after.keyframe_ids), len(before.keyframe_ids))
        self.assertEqual(len(set(after.keyframe_ids)), len(after.keyframe_ids))

    def test_encodings(self):
        for color, depth in (("rgb8", "16UC1"), ("mono8", "32FC1")):
            state = self.camera.track(0, color_encoding=color, depth_encoding=depth)
            self.assertTrue(state.input_ok, state.reason)

    def test_bad_frames_are_named_and_survived(self):
        self.start("bad")
        for index in range(3):
            self.camera.track(index)
        for faults, expected in (
                (dict(depth_scale=2), "160"),
                (dict(color_encoding="h264"), "h264"),
                (dict(depth_encoding="64FC9"), "64FC9"),
                (dict(without_depth=True), "depth"),
                (dict(covered=True), "depth"),
                (dict(depth_frame_id="ir_optical"), "ir_optical")):
            state = self.camera.track(3, **faults)
            self.assertEqual(state.status, TrackingState.LOST, faults)
            self.assertFalse(state.input_ok)
            self.assertIn(expected, state.reason)
        states = [self.camera.track(3) for _ in range(5)]
        self.assertIn(states[-1].status, TRACKED, states[-1].reason)
        self.assertTrue(states[-1].input_ok)
        self.assertEqual(self.tracker.stop().status.code, Status.OK)

    def test_debug_image(self):
        images = []
        subscriber = listen("left/camera_tracker/debug_image", Image, images.append)
        self.start("debug")
        for index in range(3):
            self.camera.track(index)
            wait_until(lambda expected=index + 1: len(images) >= expected, "the image of frame %d" % index)
        self.tracker.stop()
        subscriber.unregister()
        self.assertEqual(len(images), 3)
        self.assertEqual((images[0].encoding, images[0].header.frame_id), ("bgr8", "left_optical"))

    def test_side_by_side(self):
        other = SyntheticCamera("right", "right_optical")
        other_tracker = Tracker("right")
        other.wait_for_listeners()
        self.start("both")
        self.assertEqual(other_tracker.start(session_id="both").status.code, Status.OK)
        for index in range(5):
            self.assertIn(self.camera.track(index).status, TRACKED)
            state = other.track(2 * index)
            self.assertIn(state.status, TRACKED)
        self.assertEqual(self.tracker.stop().status.code, Status.OK)
        self.assertEqual(other_tracker.stop().status.code, Status.OK)
        self.assertEqual(get_session("right", "both").session.camera_frame_id, "right_optical")
        # Here the camera hangs below the session.
        transform = self.buffer.lookup_transform("right_session", "right_optical", state.header.stamp,
                                                 rospy.Duration(2)).transform
        self.assertAlmostEqual(transform.translation.x, 0.032, 2)
        self.assertEqual(self.parent_of("right_optical"), "right_session")
        self.assertEqual(self.parent_of("left_session"), "left_optical")

    def parent_of(self, frame):
        for line in self.buffer.all_frames_as_string().splitlines():
            if line.startswith("Frame %s exists with parent" % frame):
                return line.split("parent ")[1].rstrip(".")
        return None

    def test_frames_that_come_too_fast(self):
        fast = SyntheticCamera("fast", "fast_optical", queue_size=200)
        tracker = Tracker("fast")
        fast.wait_for_listeners()
        self.assertEqual(tracker.start(session_id="fast").status.code, Status.OK)
        for index in range(3):
            fast.track(index)
        poses = []
        subscriber = listen("fast/camera_tracker/pose", PoseWithCovarianceStamped, poses.append)
        tracker_pid = xmlrpc.client.ServerProxy(rosnode.get_api_uri(rosgraph.Master("/test"),
                                                                    "/fast/camera_tracker")).getPid("/test")[2]
        for burst in (range(3, 23), range(23, 43), range(43, 63)):
            # The tracker gets no time meanwhile: how many it may drop must not depend on who is quicker.
            os.kill(tracker_pid, signal.SIGSTOP)
            try:
                last = fast.send_at_once(burst)
                time.sleep(0.2)
            finally:
                os.kill(tracker_pid, signal.SIGCONT)
            state = fast.wait_for_state(lambda s, last=last: s.header.stamp == last)
            self.assertIn(state.status, TRACKED, state.reason)
        self.assertGreater(state.dropped_frames, 5)
        self.assertEqual(state.frame_count + state.dropped_frames, 63)
        self.assertEqual(state.tracked_count, state.frame_count)
        wait_until(lambda: poses and poses[-1].header.stamp == last, "the pose of the last frame")
        error_m = abs(poses[-1].pose.pose.position.x - SCENE.world_from_camera(62)[1][0])
        self.assertLess(error_m, 0.006)
        tracker.reset()
        subscriber.unregister()

    def test_every_second_or_third_frame_only(self):
        for step in (2, 3):
            self.start("every_%d" % step)
            for index in range(0, 60, step):
                state = self.camera.track(index)
                self.assertIn(state.status, TRACKED, "frame %d of every %d: %s" % (index, step, state.reason))
            self.tracker.stop()

    def test_recording_played_again(self):
        self.start("again")
        for index in range(3):
            self.camera.track(index)
        first = self.camera.stamp
        self.camera.stamp -= rospy.Duration(100)
        state = self.camera.track(1)
        self.assertEqual(state.status, TrackingState.LOST)
        for text in ("not newer", "played again", "~start"):
            self.assertIn(text, state.reason)
        self.tracker.stop()
        self.start("and_again")
        self.assertIn(self.camera.track(1).status, TRACKED)
        self.tracker.stop()
        self.camera.stamp = first


class SilentInputsTest(unittest.TestCase):
    @staticmethod
    def send_until(camera, text, **faults):
        """Sends frames until a reason of the tracker contains `text`; returns all reasons."""
        def said():
            camera.send(0, **faults)
            return any(text in state.reason for state in camera.states)
        wait_until(said, "'%s' in ~state" % text)
        return next(state.reason for state in camera.states if text in state.reason)

    def test_1_silent_topics_are_named(self):
        camera = SyntheticCamera("silent", with_info=False)
        state = camera.wait_for_state(lambda s: "/silent/rgb/image_rect_color" in s.reason)
        self.assertFalse(state.input_ok)
        self.send_until(camera, "no message on /silent/rgb/camera_info yet")

    def test_2_unsynchronised_streams(self):
        camera = SyntheticCamera("silent")
        camera.wait_for_listeners()
        self.assertIn("0.02", self.send_until(camera, "synchronised", depth_shift_s=500.0))

    def test_object_mode_waits_for_masks(self):
        camera = SyntheticCamera("object", with_masks=True)
        tracker = Tracker("object")
        camera.wait_for_listeners()
        self.assertEqual(tracker.start(session_id="masked").status.code, Status.OK)
        for index in range(3):
            self.assertIn(camera.track(index).status, TRACKED)
        for _ in range(20):
            camera.send(3, with_mask=False)
            rospy.sleep(0.1)
        camera.wait_for_state(lambda s: not s.input_ok and "/object/object_mask" in s.reason)
        self.assertIn(camera.track(3).status, TRACKED)
        ended = tracker.stop()
        self.assertEqual((ended.frame_count, ended.dropped_frames), (4, 20))

    def test_object_mode_looks_for_the_object_itself(self):
        camera = SyntheticCamera("own_masks")
        tracker = Tracker("own_masks")
        camera.wait_for_listeners()
        self.assertEqual(tracker.start(session_id="bare").status.code, Status.OK)
        state = camera.track(0)
        self.assertTrue(state.input_ok)
        self.assertEqual(state.status, TrackingState.NOT_STARTED)
        self.assertIn("no object in view: ", state.reason)
        tracker.reset()

    def test_no_store(self):
        response = Tracker("alone").start(session_id="x")
        self.assertEqual(response.status.code, Status.FAILED_PRECONDITION)
        self.assertIn("/alone/camera_tracker/keyframe", response.status.message)


class ParametersTest(unittest.TestCase):
    def test_all_mistakes_are_said(self):
        rospy.set_param("mistaken/tracker/max_featuers", 3)
        rospy.set_param("mistaken/tracker/seed", "one")
        rospy.set_param("mistaken/reference", "moon")
        rospy.set_param("mistaken/input_timeout_s", -1)
        code, output = NodeProcess("camera_tracker", "__name:=mistaken").wait()
        self.assertEqual(code, 1)
        for text in ("tracker/max_featuers", "tracker/seed", "moon", "input_timeout_s"):
            self.assertIn(text, output)


class ShutdownTest(unittest.TestCase):
    def test_ends_while_stop_waits_for_keyframes_that_never_arrive(self):
        asked, created = [], []

        def get_session(request):
            asked.append(request.session_id)
            return srv.GetSessionResponse(status=Status(code=Status.OK if created else Status.NOT_FOUND))

        def create_session(request):
            created.append(request.session)
            return srv.CreateSessionResponse()

        services = [rospy.Service("ending/keyframe_store/" + name, kind, answer) for name, kind, answer in (
            ("get_session", srv.GetSession, get_session), ("create_session", srv.CreateSession, create_session),
            ("list_sessions", srv.ListSessions, lambda _: srv.ListSessionsResponse()))]
        subscriber = rospy.Subscriber("ending/camera_tracker/keyframe", Keyframe, lambda _: None)
        process = NodeProcess("camera_tracker", "__name:=camera_tracker", "__ns:=ending")
        camera, tracker = SyntheticCamera("ending"), Tracker("ending")
        camera.wait_for_listeners()
        wait_until(lambda: tracker.start(session_id="ends").status.code == Status.OK, "a tracker that is heard")
        self.assertIn(camera.track(0).status, TRACKED)
        before = len(asked)

        def stop():
            try:
                tracker.stop()
            except rospy.ServiceException:
                pass  # the connection closed first

        caller = threading.Thread(target=stop)
        caller.start()
        wait_until(lambda: len(asked) > before + 3, "the tracker to wait for its keyframe")
        code, output = process.interrupt(15)
        self.assertEqual(code, 0, output)
        caller.join(15)
        self.assertFalse(caller.is_alive())
        subscriber.unregister()
        for service in services:
            service.shutdown()


if __name__ == "__main__":
    rospy.init_node("test_camera_tracker")
    rostest.rosrun("object_modelling", "test_camera_tracker", "__main__")

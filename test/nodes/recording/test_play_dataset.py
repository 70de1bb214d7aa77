#!/usr/bin/python3
"""play_dataset on the shipped recording and on bags: stamps, pace, rectification, masks, all that can go wrong."""
import os
import shutil
import sys
import tempfile
import threading
import unittest

import rosbag
import rospy
import rostest
from sensor_msgs.msg import CameraInfo, Image

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support")]
# pylint: disable=wrong-import-position
from node_process import NodeProcess
from synthetic_camera import SCENE, SyntheticCamera, image_message
from waiting import wait_until
from object_modelling.msg import TrackingState


class Listener:
    """Takes what is played; as a tracker, it answers each frame."""

    def __init__(self, namespace, answers=False):
        self.namespace = namespace
        self.received = {"color": [], "depth": [], "info": [], "mask": []}
        self.times = []
        self.mute = False
        self._answer = rospy.Publisher(namespace + "/camera_tracker/state", TrackingState, queue_size=10,
                                       latch=True) if answers else None
        self._lock = threading.Lock()
        self._subscribers = [
            rospy.Subscriber(namespace + "/rgb/image_rect_color", Image, self._take, "color"),
            rospy.Subscriber(namespace + "/depth_registered/image_rect", Image, self._take, "depth"),
            rospy.Subscriber(namespace + "/rgb/camera_info", CameraInfo, self._take, "info"),
            rospy.Subscriber(namespace + "/object_mask", Image, self._take, "mask"),
        ]

    def _take(self, message, what):
        with self._lock:
            self.received[what].append(message)
            if what != "depth":
                return
            self.times.append(rospy.get_time())
        if self._answer and not self.mute:
            state = TrackingState()
            state.header.stamp = message.header.stamp
            self._answer.publish(state)

    def stamps(self, what):
        return sorted(m.header.stamp.to_sec() for m in self.received[what])

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


class PlayDatasetTest(unittest.TestCase):
    def setUp(self):
        self.recording = rospy.get_param("~recording")
        self.folder = tempfile.mkdtemp()
        self.listeners = []

    def tearDown(self):
        shutil.rmtree(self.folder)
        for listener in self.listeners:
            listener.close()

    def listen(self, **more):
        self.listeners.append(Listener("/" + self._testMethodName, **more))
        return self.listeners[-1]

    def play(self, *arguments):
        return NodeProcess("play_dataset", *(arguments + ("__ns:=" + self._testMethodName,)))

    def recorded_stamps(self):
        with open(os.path.join(self.recording, "associations.txt")) as lines:
            return [float(line.split()[0]) for line in lines if not line.startswith("#")]

    def assert_stamps(self, stamps, expected):
        self.assertEqual(len(stamps), len(expected))
        for stamp, wanted in zip(stamps, expected):
            self.assertAlmostEqual(stamp, wanted, 5)

    def test_lossless(self):
        listener = self.listen(answers=True)
        code, output = self.play(self.recording, "--lossless").wait()
        self.assertEqual(code, 0, output)
        self.assertIn("played 31 frames of " + self.recording, output)
        for what in ("color", "depth", "info", "mask"):
            self.assert_stamps(listener.stamps(what), self.recorded_stamps())
        color, depth = listener.received["color"][0], listener.received["depth"][0]
        self.assertEqual((color.encoding, depth.encoding), ("bgr8", "32FC1"))
        self.assertEqual((color.width, color.height), (640, 480))
        self.assertAlmostEqual(listener.received["info"][0].P[0], 570.3)

    def test_rate(self):
        listener = self.listen()
        code, output = self.play(self.recording, "--rate", "2").wait()
        self.assertEqual(code, 0, output)
        self.assertEqual(len(listener.times), 31)
        duration = listener.times[-1] - listener.times[0]
        self.assertGreater(duration, 5.0 / 2 - 0.2)
        self.assertLess(duration, 5.0 - 0.2)

    def test_loop(self):
        listener = self.listen(answers=True)
        process = self.play(self.recording, "--lossless", "--loop")
        wait_until(lambda: len(listener.received["depth"]) >= 70, "70 depth images", 20)
        code, output = process.interrupt()
        self.assertEqual(code, 0, output)
        stamps = [m.header.stamp for m in listener.received["color"]]
        self.assertGreaterEqual(len(stamps), 70)
        self.assertEqual(sorted(set(stamps)), stamps)
        first = self.recorded_stamps()
        self.assertAlmostEqual(stamps[31].to_sec(), 2 * first[-1] - first[-2], 3)

    def test_distorted_recordings_are_rectified(self):
        distorted = os.path.join(self.folder, "distorted")
        shutil.copytree(self.recording, distorted)
        path = os.path.join(distorted, "camera.yaml")
        with open(path) as lines:
            kept = [line for line in lines if not line.startswith("distortion")]
        with open(path, "w") as camera:
            camera.writelines(kept + ["distortion: [0.2, -0.1, 0.001, 0.002, 0.0]\n"])
        plain = self.listen(answers=True)
        self.play(self.recording, "--lossless").wait()
        straight = plain.received["color"][0].data
        plain.received = {key: [] for key in plain.received}
        code, output = self.play(distorted, "--lossless").wait()
        self.assertEqual(code, 0, output)
        info = plain.received["info"][0]
        self.assertAlmostEqual(info.D[0], 0.2)
        self.assertEqual(info.distortion_model, "plumb_bob")
        self.assertAlmostEqual(info.K[0], 570.3)
        self.assertGreater(info.P[0], 0)
        self.assertNotEqual(plain.received["color"][0].data, straight)

    def write_bag(self, name, colors=("/camera/rgb/image_rect_color",), frames=5):
        path = os.path.join(self.folder, name)
        camera = SyntheticCamera.__new__(SyntheticCamera)
        camera.frame_id = "cam"
        with rosbag.Bag(path, "w") as bag:
            for index in range(frames):
                camera.stamp = rospy.Time(2000) + rospy.Duration(index / 30.0)
                color, depth = SCENE.render(index)
                bag.write("/camera/rgb/camera_info", camera.camera_info(), camera.stamp)
                for topic in colors:
                    bag.write(topic, image_message(color, "bgr8", camera.stamp, "cam"), camera.stamp)
                depth_stamp = camera.stamp + rospy.Duration(0.007)
                bag.write("/camera/depth_registered/image_rect",
                          image_message((depth * 1000).astype("uint16"), "16UC1", depth_stamp, "cam"), depth_stamp)
        return path

    def test_bag(self):
        listener = self.listen(answers=False)
        code, output = self.play(self.write_bag("good.bag"), "--rate", "1").wait()
        self.assertEqual(code, 0, output)
        self.assert_stamps(listener.stamps("color"), [2000 + i / 30.0 for i in range(5)])
        self.assert_stamps(listener.stamps("depth"), [2000.007 + i / 30.0 for i in range(5)])

    def test_ambiguous_bag(self):
        path = self.write_bag("two.bag", colors=("/a/image_color", "/b/image_color"))
        code, output = self.play(path, "--wait", "0").wait()
        self.assertEqual(code, 1)
        self.assertIn("/a/image_color", output)
        self.assertIn("/b/image_color", output)
        code, output = self.play(path, "--wait", "0", "--color-topic", "/a/image_color", "--rate", "10").wait()
        self.assertEqual(code, 0, output)

    def test_unindexed_bag(self):
        path = self.write_bag("cut.bag", frames=20)
        with open(path, "r+b") as bag:
            bag.truncate(os.path.getsize(path) // 2)
        code, output = self.play(path, "--wait", "0").wait()
        self.assertEqual(code, 1)
        self.assertIn(path, output)

    def test_nobody_answers(self):
        code, output = self.play(self.recording, "--lossless", "--wait", "0.5").wait()
        self.assertEqual(code, 1)
        self.assertIn("/test_nobody_answers/camera_tracker/state", output)

    def test_silent_tracker(self):
        listener = self.listen(answers=True)
        listener.mute = True
        code, output = self.play(self.recording, "--lossless", "--answer-timeout", "0.5").wait()
        self.assertEqual(code, 1)
        self.assertIn("no answer on /test_silent_tracker/camera_tracker/state to frame 1", output)

    def test_usage(self):
        self.assertEqual(self.play().wait()[0], 2)
        self.assertEqual(self.play(self.recording, "--rate", "0").wait()[0], 2)
        self.assertEqual(self.play(self.recording, "--rate", "2", "--lossless").wait()[0], 2)
        code, output = self.play("--help").wait()
        self.assertEqual(code, 0)
        self.assertIn("--lossless", output)
        for name, text in (("none", "no such recording"), ("a.oni", ".oni is not supported yet"),
                           ("a.txt", "TUM-style")):
            path = os.path.join(self.folder, name)
            if name != "none":
                open(path, "w").close()
            code, output = self.play(path).wait()
            self.assertEqual(code, 1)
            self.assertIn(text, output)


if __name__ == "__main__":
    rospy.init_node("test_play_dataset")
    rostest.rosrun("object_modelling", "test_play_dataset", PlayDatasetTest)

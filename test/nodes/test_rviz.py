#!/usr/bin/python3
"""rviz with our configs, on a virtual screen: loads, subscribes to what the nodes publish, draws it. Its screenshots
are in the folder of the test's logs."""
import os
import re
import subprocess
import time
import unittest

import rospkg
import rospy
import tf2_ros
from geometry_msgs.msg import Point, PoseStamped, TransformStamped
from nav_msgs.msg import Path
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray
import numpy

CONFIGS = os.path.join(rospkg.RosPack().get_path("object_modelling"), "rviz")
HEADER = Header(frame_id="session")


def cloud(x_m, z_m=0.8, header=HEADER):
    """A red square of 0.2 m."""
    points = numpy.zeros((10000, 4), numpy.float32)
    points[:, 0] = x_m + numpy.tile(numpy.linspace(-0.1, 0.1, 100), 100)
    points[:, 1] = numpy.repeat(numpy.linspace(-0.1, 0.1, 100), 100)
    points[:, 2] = z_m
    points[:, 3].view(numpy.uint32)[:] = 0xFF0000
    fields = [PointField(name, 4 * index, PointField.FLOAT32, 1) for index, name in enumerate(("x", "y", "z", "rgb"))]
    return PointCloud2(header=header, height=1, width=len(points), fields=fields, point_step=16, data=points.tobytes(),
                       row_step=16 * len(points), is_dense=True)


def marker(kind, color, points):
    result = Marker(header=HEADER, type=kind, color=color, points=points)
    result.pose.orientation.w = 1
    result.scale.x = result.scale.y = result.scale.z = 1 if kind == Marker.TRIANGLE_LIST else 0.005
    return result


def publish_everything():
    """What the nodes publish, under their names; the publishers must be kept."""
    blue = marker(Marker.TRIANGLE_LIST, ColorRGBA(0, 0, 1, 1), [Point(-0.4, -0.1, 0.8), Point(-0.2, 0.1, 0.8),
                                                                Point(-0.2, -0.1, 0.8)])
    green = marker(Marker.LINE_STRIP, ColorRGBA(0, 1, 0, 1), [Point(0, 0, 0.5), Point(0.3, 0.2, 0.5)])
    image = Image(header=HEADER, height=48, width=64, encoding="bgr8", step=192, data=bytes([200, 100, 0] * 3072))
    path = Path(header=HEADER, poses=[PoseStamped(header=HEADER) for _ in range(2)])
    path.poses[1].pose.position.x = 0.3
    messages = {"camera_tracker/debug_image": image, "keyframe_store/cloud": cloud(0), "keyframe_store/path": path,
                "keyframe_store/frusta": MarkerArray([green]), "segmenter/hypotheses_markers": MarkerArray([green]),
                "segmenter/hypotheses_cloud": cloud(0.3), "model_builder/model_mesh": blue}
    return publish(messages)


def publish_a_pair():
    """As session_aligner does, in a frame that is not in tf."""
    header = Header(frame_id="alignment")
    square = cloud(0, 0, header)
    label = Marker(header=header, type=Marker.TEXT_VIEW_FACING, text="0: features", color=ColorRGBA(0.2, 1, 0.3, 1))
    label.pose.position.z = 0.15
    label.pose.orientation.w = 1
    label.scale.z = 0.08
    return publish({"session_aligner/parts": square, "session_aligner/labels": MarkerArray([label])})


def publish(messages):
    publishers = {}
    for topic, message in messages.items():
        publishers[topic] = rospy.Publisher(topic, type(message), queue_size=1, latch=True)
        publishers[topic].publish(message)
    return publishers


class RvizTest(unittest.TestCase):
    def test_everything_is_drawn(self):
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        transform = TransformStamped(header=Header(frame_id="camera"), child_frame_id="session")
        transform.transform.rotation.w = 1
        broadcaster.sendTransform(transform)
        self.check("object_modelling", publish_everything(), {"red", "blue", "green", "image"})

    def test_a_pair_to_decide_on_is_drawn(self):
        self.check("alignment", publish_a_pair(), {"red", "green"})

    def check(self, config, publishers, wanted):
        rviz = subprocess.Popen(["rviz", "-d", os.path.join(CONFIGS, config + ".rviz"), "__name:=rviz_" + config],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        try:
            end = time.monotonic() + 60
            while time.monotonic() < end and not all(p.get_num_connections() for p in publishers.values()):
                self.assertIsNone(rviz.poll(), "rviz has ended")
                time.sleep(0.2)
            self.assertEqual([t for t, p in publishers.items() if not p.get_num_connections()], [],
                             "topics that rviz does not listen to")
            colors = {}
            while time.monotonic() < end and not wanted <= set(colors):
                time.sleep(1)
                colors = self.look(config + ".png")
            self.assertLessEqual(wanted, set(colors), "colours on the screen")
        finally:
            rviz.terminate()
            log = rviz.communicate(timeout=20)[0]
        self.assertNotRegex(log, re.compile("could not be loaded|failed to load|PluginlibFactory", re.IGNORECASE))

    @staticmethod
    def look(picture):
        """Which of the colours that were published are on the screen."""
        subprocess.run(["import", "-window", "root", picture], check=True, timeout=20)
        raw = subprocess.run(["convert", picture, "-depth", "8", "rgb:-"], check=True, timeout=20,
                             stdout=subprocess.PIPE).stdout
        pixels = numpy.frombuffer(raw, numpy.uint8).reshape(-1, 3).astype(int)
        r, g, b = pixels.T
        wanted = {"red": (r > 150) & (g < 40) & (b < 40), "blue": (b > 100) & (r < 40) & (g < 40),
                  "green": (g > 150) & (r < 80) & (b < 130), "image": (r < 5) & (abs(g - 100) < 5) & (abs(b - 200) < 5)}
        return {name: int(mask.sum()) for name, mask in wanted.items() if mask.sum() > 50}


if __name__ == "__main__":
    import rostest

    rospy.init_node("test_rviz")
    rostest.rosrun("object_modelling", "test_rviz", RvizTest)

#!/usr/bin/python3
"""Detections arrive in the messages of other packages, those of them that are there; goals are answered in the image
that comes with them. The recogniser is a fake one, the messages are made here."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import actionlib
import numpy as np
import roslib.packages
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point32
from sensor_msgs.msg import CameraInfo, Image, RegionOfInterest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "support"), HERE]
# pylint: disable=wrong-import-position
import foreign_messages
from waiting import listen, wait_until
from object_modelling import msg, srv
from object_modelling.adapters import poses
from object_modelling.outcome import Code

FOLDER = tempfile.mkdtemp()
foreign_messages.make_all(FOLDER)
sys.path.insert(0, FOLDER)
# pylint: disable=import-error
import object_recognition_msgs.msg
import robokudo_msgs.msg
import vision_msgs.msg

WIDTH, HEIGHT, FOCAL = 320, 240, 300.0
SIDE_M = 0.1  # of the cubes
STAMP = rospy.Time(12, 5)
ACTION = "recognition_adapter/estimate_poses"


def detection(object_id, x_m, z_m, confidence):
    """A cube whose box is 10 mm beside the origin of its frame and turned by a quarter about z."""
    found = msg.Detection(object_id=object_id, content_hash="hash_" + object_id, confidence_ratio=confidence)
    found.pose.pose.position.x, found.pose.pose.position.z, found.pose.pose.orientation.w = x_m, z_m, 1
    found.pose.covariance = np.arange(36.0)
    found.size_m.x = found.size_m.y = found.size_m.z = SIDE_M
    found.model_from_box.position.x = 0.01
    found.model_from_box.orientation.z = found.model_from_box.orientation.w = 0.5 ** 0.5
    return found


def cube():
    """Mesh of the box in the object's frame."""
    mesh = msg.TriangleMesh(triangles=[corner for triangle in poses.BOX_TRIANGLES for corner in triangle])
    at_origin = detection("", 0, 0, 1)
    mesh.vertices = [Point32(*corner) for corner in poses.corners(at_origin)]
    return mesh


class FakeRecogniser:
    """Two cubes: a near one, and behind it to the right a far one."""

    def __init__(self):
        self.requests = []
        self.status = msg.Status()
        self.detections = msg.Detections(detections=[detection("7_mug", 0, 0.6, 0.9), detection("box", 0.12, 0.8, 0.7),
                                                     detection("7_cup", -0.3, 0.9, 0.4)])
        self.detections.header.stamp, self.detections.header.frame_id = STAMP, "optical"
        self.topic = rospy.Publisher("recogniser/detections", msg.Detections, queue_size=5)
        self.database = rospy.Publisher("recogniser/database", msg.KnownObjects, queue_size=1, latch=True)
        self.database.publish(msg.KnownObjects(ids=["7_cup", "7_mug", "box"]))
        self.services = [rospy.Service("recogniser/recognise", srv.Recognise, self._recognise),
                         rospy.Service("recogniser/get_object_model", srv.GetObjectModel, self._model)]

    def _recognise(self, request):
        self.requests.append(request)
        answer = srv.RecogniseResponse(status=self.status)
        if self.status.code == Code.OK:
            answer.detections = self.detections
        return answer

    @staticmethod
    def _model(request):
        return srv.GetObjectModelResponse(object=msg.ObjectModel(object_id=request.object_id, mesh=cube()))


class Adapter:
    """The node's process. `path`: first in its PYTHONPATH."""

    def __init__(self, path):
        program = roslib.packages.find_node("object_modelling", "recognition_adapter")[0]
        environment = dict(os.environ, PYTHONPATH=path + ":" + os.environ["PYTHONPATH"], PYTHONUNBUFFERED="1")
        self.log_path = os.path.join(FOLDER, "log")
        with open(self.log_path, "w") as log:
            self.process = subprocess.Popen([program], env=environment, stdout=log, stderr=subprocess.STDOUT)

    def log(self):
        with open(self.log_path) as text:
            return text.read()

    def stop(self):
        self.process.terminate()
        self.process.wait(timeout=20)


class RecognitionAdapterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.fake = FakeRecogniser()
        cls.info = rospy.Publisher("own/camera_info", CameraInfo, queue_size=1, latch=True)
        info = CameraInfo(width=WIDTH, height=HEIGHT)
        info.K = [FOCAL, 0, WIDTH / 2, 0, FOCAL, HEIGHT / 2, 0, 0, 1]
        info.P = [FOCAL, 0, WIDTH / 2, 0, 0, FOCAL, HEIGHT / 2, 0, 0, 0, 1, 0]
        cls.info.publish(info)
        rospy.set_param("/cam_info_topic", "/own/camera_info")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)

    def setUp(self):
        self.fake.status = msg.Status()

    def start(self, path=FOLDER):
        adapter = Adapter(path)
        self.addCleanup(adapter.stop)
        return adapter

    @staticmethod
    def absent(folder, package):
        os.makedirs(os.path.join(folder, package))
        with open(os.path.join(folder, package, "__init__.py"), "w") as text:
            text.write("raise ImportError('No module named %s')\n" % package)

    def test_without_any_package(self):
        folder = tempfile.mkdtemp(dir=FOLDER)
        for package in ("object_recognition_msgs", "vision_msgs", "robokudo_msgs", "object_detector_msgs"):
            self.absent(folder, package)
        adapter = self.start(folder)
        wait_until(lambda: "nothing is offered" in adapter.log(), "the warning", 30)
        for words in ("~recognized_objects is not offered: package object_recognition_msgs is not found",
                      "~detections_3d is not offered: package vision_msgs is not found",
                      "~estimate_poses is not offered: package robokudo_msgs is not found",
                      "apt-get install ros-$ROS_DISTRO-vision-msgs", "github.com/v4r-tuwien"):
            self.assertIn(words, adapter.log())
        self.assertIsNone(adapter.process.poll())

    def test_another_version_of_one(self):
        folder = tempfile.mkdtemp(dir=FOLDER)
        foreign_messages.make(folder, "vision_msgs", foreign_messages.OTHER_VISION)
        adapter = self.start(folder + ":" + FOLDER)
        wait_until(lambda: "~estimate_poses is offered" in adapter.log(), "the other messages", 30)
        self.assertIn("vision_msgs is another version: it lacks ObjectHypothesisWithPose.id", adapter.log())
        self.assertIn("~recognized_objects is offered", adapter.log())

    def test_topics(self):
        seen = {}
        adapter = self.start()
        wait_until(lambda: "~estimate_poses is offered" in adapter.log(), "all offers", 30)
        topics = {"recognized_objects": object_recognition_msgs.msg.RecognizedObjectArray,
                  "detections_3d": vision_msgs.msg.Detection3DArray, "vision_info": vision_msgs.msg.VisionInfo}
        listeners = [listen("recognition_adapter/" + topic, kind, lambda m, topic=topic: seen.update({topic: m}))
                     for topic, kind in topics.items()]
        wait_until(lambda: self.fake.topic.get_num_connections() > 0, "the adapter")
        self.fake.topic.publish(self.fake.detections)
        wait_until(lambda: len(seen) == 3, "all messages")
        self.check_recognized(seen["recognized_objects"])
        self.check_detections(seen["detections_3d"], seen["vision_info"])
        del listeners

    def check_recognized(self, message):
        self.assertEqual((message.header.stamp, message.header.frame_id), (STAMP, "optical"))
        self.assertEqual([o.type.key for o in message.objects], ["7_mug", "box", "7_cup"])
        first = message.objects[0]
        self.assertEqual(json.loads(first.type.db)["content_hash"], "hash_7_mug")
        self.assertAlmostEqual(first.confidence, 0.9, places=6)
        self.assertEqual((first.pose.header.frame_id, first.pose.pose.pose.position.z), ("optical", 0.6))
        self.assertEqual(list(first.pose.pose.covariance), list(range(36)))
        corners = np.array([(p.x, p.y, p.z) for p in first.bounding_mesh.vertices])
        np.testing.assert_allclose(corners.mean(0), [0.01, 0, 0.6], atol=1e-9)
        np.testing.assert_allclose(np.ptp(corners, 0), 3 * [SIDE_M], atol=1e-9)
        triangles = corners[np.array([t.vertex_indices for t in first.bounding_mesh.triangles])] - corners.mean(0)
        volumes = np.linalg.det(triangles) / 6
        self.assertTrue((volumes > 0).all())  # counter-clockwise seen from outside
        self.assertAlmostEqual(volumes.sum(), SIDE_M ** 3)

    def check_detections(self, message, info):
        self.assertEqual((message.header.stamp, message.detections[0].header.frame_id), (STAMP, "optical"))
        self.assertEqual(info.method, "object_modelling")
        names = rospy.get_param(info.database_location)
        self.assertEqual([names[str(d.results[0].id)] for d in message.detections], ["7_mug", "box", "7_cup"])
        self.assertEqual(len(names), 3)
        first = message.detections[0]
        self.assertEqual((first.results[0].score, first.results[0].pose.pose.position.z), (0.9, 0.6))
        np.testing.assert_allclose([first.bbox.center.position.x, first.bbox.center.position.z], [0.01, 0.6])
        self.assertAlmostEqual(first.bbox.center.orientation.z, 0.5 ** 0.5)
        self.assertEqual(first.bbox.size.x, SIDE_M)

    @staticmethod
    def goal(depth_m=1.0, **more):
        rgb = Image(height=HEIGHT, width=WIDTH, encoding="rgb8", step=3 * WIDTH, data=bytes(3 * WIDTH * HEIGHT))
        rgb.header.frame_id, rgb.header.stamp = "optical", STAMP
        depth = Image(header=rgb.header, height=HEIGHT, width=WIDTH, encoding="16UC1", step=2 * WIDTH,
                      data=np.full((HEIGHT, WIDTH), 1000 * depth_m, "<u2").tobytes())
        return robokudo_msgs.msg.GenericImgProcAnnotatorGoal(rgb=rgb, depth=depth, **more)

    def answer(self, state=GoalStatus.SUCCEEDED, **more):
        self.client.send_goal(self.goal(**more))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(20)))
        self.assertEqual(self.client.get_state(), state, self.client.get_goal_status_text())
        return self.client.get_result()

    def test_action(self):
        self.start()
        self.client = actionlib.SimpleActionClient(ACTION, robokudo_msgs.msg.GenericImgProcAnnotatorAction)
        self.assertTrue(self.client.wait_for_server(rospy.Duration(30)))
        self.gives_all_with_labels()
        self.keeps_to_regions()
        self.refuses()

    def gives_all_with_labels(self):
        result = self.answer()
        request = self.fake.requests[-1]
        self.assertEqual((request.color.header.stamp, request.depth.encoding, request.camera_info.width),
                         (STAMP, "16UC1", WIDTH))
        self.assertTrue(result.success)
        self.assertEqual(list(result.class_names), ["7_mug", "box", "7_cup"])
        np.testing.assert_allclose(result.class_confidences, [0.9, 0.7, 0.4], rtol=1e-6)
        self.assertEqual(result.pose_results[1], self.fake.detections.detections[1].pose.pose)
        self.assertEqual((result.image.encoding, result.image.header.stamp), ("16SC1", STAMP))
        labels = np.frombuffer(result.image.data, np.int16).reshape(HEIGHT, WIDTH)
        front_m = 0.6 - SIDE_M / 2
        self.assertAlmostEqual((labels == 0).sum(), (FOCAL * SIDE_M / front_m) ** 2, delta=250)
        self.assertEqual(labels[HEIGHT // 2, WIDTH // 2], 0)
        self.assertEqual(labels[0, 0], -1)
        self.assertEqual(set(np.unique(labels)), {-1, 0, 1, 2})
        box = result.bounding_boxes[0]
        self.assertAlmostEqual(box.width, FOCAL * SIDE_M / front_m, delta=3)
        near = np.frombuffer(self.answer(depth_m=0.3).image.data, np.int16)
        self.assertEqual(set(near), {-1})  # all is hidden

    def keeps_to_regions(self):
        mask = np.zeros((HEIGHT, WIDTH), np.uint8)
        mask[:, WIDTH // 2 + 30:] = 255
        mask = Image(height=HEIGHT, width=WIDTH, encoding="mono8", step=WIDTH, data=mask.tobytes())
        self.assertEqual(list(self.answer(mask_detections=[mask]).class_names), ["box"])
        whole = RegionOfInterest(width=WIDTH, height=HEIGHT)
        self.assertEqual(list(self.answer(bb_detections=[whole]).class_names), ["7_mug"])
        result = self.answer(bb_detections=[whole, whole], class_names=["box", "kettle"])
        self.assertEqual(list(result.class_names), ["box"])
        self.assertEqual(list(self.answer(class_names=["7_cup"]).class_names), ["7_cup"])
        nothing = self.answer(class_names=["kettle"])
        self.assertEqual((nothing.success, len(nothing.pose_results)), (False, 0))
        self.assertIn("nothing", nothing.result_feedback)

    def refuses(self):
        result = self.answer(GoalStatus.ABORTED, bb_detections=[RegionOfInterest()], class_names=["a", "b"])
        self.assertIn("2 class_names", result.result_feedback)
        self.fake.status = msg.Status(code=Code.FAILED_PRECONDITION, message="still being learnt")
        result = self.answer(GoalStatus.ABORTED)
        self.assertEqual((result.success, result.result_feedback), (False, "still being learnt"))


if __name__ == "__main__":
    import rostest
    rospy.init_node("test_recognition_adapter")
    rostest.rosrun("object_modelling", "test_recognition_adapter", RecognitionAdapterTest)

#!/usr/bin/python3
"""The node follows a database while it runs, finds its objects where they are, and says what is wrong with a call."""
import os
import shutil
import subprocess
import sys
import time
import unittest

import cv2
import numpy as np
import roslib.packages
import rospy
import tf2_ros
import yaml
from sensor_msgs.msg import CameraInfo, Image
from visualization_msgs.msg import Marker, MarkerArray

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", folder) for folder in ("exporters", "support", "nodes/recording")]
# pylint: disable=wrong-import-position
import small_database
from synthetic_camera import image_message
from waiting import listen, wait_until
from object_modelling import msg, srv
from object_modelling.outcome import Code

RECORDING = os.path.join(HERE, "..", "data", "mustard_handheld_simulated")
STAMP = "1003.066667"  # of the image; no view of the model has it
FRAME_ID = "camera_rgb_optical_frame"
TIMEOUT_S = 2.0  # input_timeout_s
LEARN_S = 40  # at most, from a change of the database to its use; some seconds on an idle machine


def pose_matrix(position, quaternion):
    x, y, z, w = quaternion
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = position
    return pose


def camera_from_model(folder):
    """True pose in the image: from the model's nearest view by the true motion of the camera."""
    rows = np.loadtxt(os.path.join(RECORDING, "groundtruth.txt"))
    world_from_camera = lambda stamp_s: pose_matrix(*np.split(rows[np.argmin(abs(rows[:, 0] - stamp_s)), 1:], [3]))
    with open(os.path.join(folder, "object.yaml")) as text:
        views = yaml.safe_load(text)["views"]
    view = min(views, key=lambda v: abs(v["stamp_s"] - float(STAMP)))
    model_from_view = np.loadtxt(os.path.join(folder, "views", "pose_%08d.txt" % view["index"]))
    view_from_camera = np.linalg.inv(world_from_camera(view["stamp_s"])) @ world_from_camera(float(STAMP))
    return np.linalg.inv(model_from_view @ view_from_camera)


class Camera:
    """Publishes one image of the recording again and again, each time with a new stamp."""

    def __init__(self):
        self._color = rospy.Publisher("rgb/image_rect_color", Image, queue_size=2)
        self._depth = rospy.Publisher("depth_registered/image_rect", Image, queue_size=2)
        self._info = rospy.Publisher("rgb/camera_info", CameraInfo, queue_size=2)
        self._images = [cv2.imread(os.path.join(RECORDING, name), cv2.IMREAD_UNCHANGED)
                        for name in ("rgb/%s.jpg" % STAMP, "depth/%s.png" % STAMP)]
        self._timer = None

    def start(self):
        self._timer = rospy.Timer(rospy.Duration(0.2), lambda event: self.send())

    def stop(self):
        self._timer.shutdown()
        self._timer.join()

    def send(self):
        for publisher, message in zip((self._info, self._color, self._depth), self.messages(rospy.Time.now())):
            publisher.publish(message)

    def messages(self, now):
        """camera_info, colour, depth."""
        info = CameraInfo(width=640, height=480, distortion_model="plumb_bob", D=[0.0] * 5)
        info.header.stamp, info.header.frame_id = now, FRAME_ID
        info.K = [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]
        info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
        info.P = [525, 0, 319.5, 0, 0, 525, 239.5, 0, 0, 0, 1, 0]
        return (info, image_message(self._images[0], "bgr8", now, FRAME_ID),
                image_message(self._images[1], "16UC1", now, FRAME_ID))


class RecogniserTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = rospy.get_param("recogniser/database_path")
        cls.folder = os.path.dirname(cls.root)
        shutil.rmtree(cls.folder, ignore_errors=True)
        cls.made = os.path.join(cls.folder, "made")
        program = roslib.packages.find_node("object_modelling", "object_modelling")[0]
        subprocess.run([program, "model", "mustard", RECORDING, "--database", cls.made], check=True, timeout=150)
        rospy.wait_for_service("recogniser/recognise", 30)
        cls.known = None
        cls.listener = listen("recogniser/database", msg.KnownObjects, lambda known: setattr(cls, "known", known))
        cls.camera = Camera()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @staticmethod
    def recognise(*object_ids, **more):
        request = srv.RecogniseRequest(object_ids=object_ids, **more)
        return rospy.ServiceProxy("recogniser/recognise", srv.Recognise)(request)

    @staticmethod
    def reload():
        return rospy.ServiceProxy("recogniser/reload", srv.ReloadDatabase)()

    def refused(self, code, words, *object_ids, **more):
        answer = self.recognise(*object_ids, **more)
        self.assertEqual(answer.status.code, code, answer.status.message)
        for word in words:
            self.assertIn(word, answer.status.message)
        self.assertEqual(answer.detections.detections, [])

    def wait_for_known(self, *ids):
        wait_until(lambda: self.known is not None and self.known.ids == list(ids), "objects %s" % (ids,), LEARN_S)

    def found(self, *object_ids, **more):
        answer = self.recognise(*object_ids, **more)
        self.assertEqual(answer.status.code, Code.OK, answer.status.message)
        return answer.detections

    def test_follows_a_database(self):
        self.without_database()
        shutil.copytree(self.made, self.root)
        self.wait_for_known("mustard")
        self.assertTrue(os.path.isfile(os.path.join(self.root, "mustard", "recognition", "knowledge.bin")))
        self.without_frames()
        self.searches_given_images()
        self.gives_the_model()
        self.camera.start()
        self.finds_the_object()
        self.publishes_without_a_call()
        self.refuses_wrong_calls()
        self.chooses_by_place()
        self.an_object_is_damaged_and_mended()
        self.an_object_is_deleted()
        self.camera.stop()
        self.refused(Code.TIMEOUT, ["after the call"], wait=rospy.Duration(0.5))

    def without_database(self):
        self.refused(Code.FAILED_PRECONDITION, [self.root, "waiting for it"])
        answer = self.reload()
        self.assertEqual((answer.status.code, answer.known.ids), (Code.NOT_FOUND, []), answer.status.message)
        os.makedirs(self.root)
        small_database.write_manifest(self.root)
        wait_until(lambda: self.known is not None and self.known.status.code == Code.OK, "the empty database", LEARN_S)
        self.refused(Code.FAILED_PRECONDITION, [self.root, "no objects"])
        shutil.rmtree(self.root)

    def without_frames(self):
        start = time.monotonic()
        self.refused(Code.FAILED_PRECONDITION, ["no frame yet", "/depth_registered/image_rect", "/rgb/camera_info"])
        self.assertGreater(time.monotonic() - start, TIMEOUT_S - 0.1)
        self.assertLess(time.monotonic() - start, TIMEOUT_S + 3)

    def given(self, **more):
        """The camera's image as part of a call; no camera has published anything."""
        images = self.camera.messages(rospy.Time(7))
        return dict(dict(zip(("camera_info", "color", "depth"), images)), **more)

    def searches_given_images(self):
        answer = self.found(**self.given())
        self.assertEqual((answer.header.stamp, answer.header.frame_id), (rospy.Time(7), FRAME_ID))
        self.assertEqual([d.object_id for d in answer.detections], ["mustard"])
        only_color = {"color": self.given()["color"]}
        self.refused(Code.INVALID_ARGUMENT, ["color", "depth", "camera_info"], **only_color)
        self.refused(Code.INVALID_ARGUMENT, ["wait"], **self.given(wait=rospy.Duration(1)))
        elsewhere = self.given()["depth"]
        elsewhere.header.frame_id = "depth_frame"
        self.refused(Code.BAD_INPUT, ["depth_frame", "registered"], **self.given(depth=elsewhere))
        small = image_message(np.ones((10, 10), np.uint16), "16UC1", rospy.Time(7), FRAME_ID)
        self.refused(Code.BAD_INPUT, ["10"], **self.given(depth=small))

    @staticmethod
    def model(object_id):
        return rospy.ServiceProxy("recogniser/get_object_model", srv.GetObjectModel)(object_id)

    def gives_the_model(self):
        answer = self.model("mustard")
        self.assertEqual(answer.status.code, Code.OK, answer.status.message)
        found = answer.object
        with open(os.path.join(self.made, "mustard", "object.yaml")) as text:
            written = yaml.safe_load(text)
        self.assertEqual((found.object_id, found.content_hash), ("mustard", self.known.content_hashes[0]))
        np.testing.assert_allclose([found.size_m.x, found.size_m.y, found.size_m.z], written["size_m"])
        np.testing.assert_allclose(found.diameter_m, written["diameter_m"])
        mesh = found.mesh
        self.assertEqual({len(mesh.vertices)}, {len(mesh.normals), len(mesh.colors)})
        self.assertEqual(len(mesh.triangles) % 3, 0)
        self.assertLess(max(mesh.triangles), len(mesh.vertices))
        corners = np.array([(v.x, v.y, v.z) for v in mesh.vertices])
        self.assertLess(np.ptp(corners, 0).max(), found.diameter_m + 1e-3)
        self.check_cloud(found.cloud, found.diameter_m)
        self.assertTrue(found.has_properties)
        self.assertAlmostEqual(sum(pose.probability for pose in found.resting_poses), 1, places=3)
        self.assertTrue(any(pose.seen for pose in found.resting_poses))
        self.assertEqual(len(found.symmetries), len(written["symmetries"]))
        self.assertAlmostEqual(found.inertia.m, found.volume_m3 * found.density_kg_m3, places=6)
        self.assertGreater(min(found.inertia.ixx, found.inertia.iyy, found.inertia.izz), 0)
        self.assertEqual(found.has_unseen, "unseen" in written)
        unknown = self.model("cup").status
        self.assertEqual(unknown.code, Code.NOT_FOUND)
        self.assertIn("mustard", unknown.message)

    def check_cloud(self, cloud, diameter_m):
        self.assertEqual([f.name for f in cloud.fields], ["x", "y", "z", "rgb", "normal_x", "normal_y", "normal_z"])
        numbers = np.frombuffer(cloud.data, np.float32).reshape(cloud.width, cloud.point_step // 4)
        self.assertLess(np.linalg.norm(numbers[:, :3], axis=1).max(), diameter_m)
        np.testing.assert_allclose(np.linalg.norm(numbers[:, 4:7], axis=1), 1, atol=1e-3)
        blue, green, red = np.frombuffer(cloud.data, np.uint8).reshape(cloud.width, -1)[:, 12:15].mean(0)
        self.assertGreater(min(red, green), blue + 20)  # mustard

    def finds_the_object(self):
        start = rospy.Time.now()
        answer = self.found("mustard", wait=rospy.Duration(10))
        self.assertGreater(answer.header.stamp, start)
        self.assertEqual(answer.header.frame_id, FRAME_ID)
        self.assertEqual([d.object_id for d in answer.detections], ["mustard"])
        detection = answer.detections[0]
        self.assertGreater(detection.confidence_ratio, 0.8)
        self.assertEqual([detection.content_hash], self.known.content_hashes)
        position, turn = detection.pose.pose.position, detection.pose.pose.orientation
        pose = pose_matrix([position.x, position.y, position.z], [turn.x, turn.y, turn.z, turn.w])
        error = np.linalg.inv(camera_from_model(os.path.join(self.made, "mustard"))) @ pose
        self.assertLess(np.linalg.norm(error[:3, 3]), 0.01)
        self.assertLess(np.rad2deg(np.arccos(np.clip((np.trace(error[:3, :3]) - 1) / 2, -1, 1))), 3)
        covariance = np.reshape(detection.pose.covariance, (6, 6))
        self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())
        self.assertGreater(min(detection.size_m.x, detection.size_m.y, detection.size_m.z), 0.05)

    def publishes_without_a_call(self):
        seen = {}
        buffer = tf2_ros.Buffer()
        listeners = [tf2_ros.TransformListener(buffer),
                     listen("recogniser/detections", msg.Detections, lambda m: seen.update(detections=m)),
                     listen("recogniser/markers", MarkerArray, lambda m: seen.update(markers=m))]
        wait_until(lambda: len(seen) == 2, "detections and markers")
        self.assertEqual([d.object_id for d in seen["detections"].detections], ["mustard"])
        kinds = [(m.action, m.type) for m in seen["markers"].markers]
        self.assertEqual(kinds, [(Marker.DELETEALL, 0), (Marker.ADD, Marker.TRIANGLE_LIST),
                                 (Marker.ADD, Marker.TEXT_VIEW_FACING)])
        mesh, text = seen["markers"].markers[1:]
        self.assertGreater(len(mesh.points), 300)
        self.assertEqual(len(mesh.points), len(mesh.colors))
        self.assertRegex(text.text, r"^mustard [01]\.\d\d$")
        wait_until(lambda: buffer.can_transform(FRAME_ID, "object_mustard_0", rospy.Time(0)), "the object's frame")
        del listeners

    def refuses_wrong_calls(self):
        self.refused(Code.NOT_FOUND, ["'cup'", "mustard"], "mustard", "cup")
        self.refused(Code.INVALID_ARGUMENT, ["wait"], wait=rospy.Duration(-1))
        self.refused(Code.INVALID_ARGUMENT, ["roi"], roi=self.roi(0, 0, 10, 0))

    @staticmethod
    def roi(left, top, width, height):
        roi = srv.RecogniseRequest().roi
        roi.x_offset, roi.y_offset, roi.width, roi.height = left, top, width, height
        return roi

    def chooses_by_place(self):
        place = self.found().detections[0].pose.pose.position
        left = int(525 * place.x / place.z + 319.5) - 50
        self.assertEqual(len(self.found(roi=self.roi(left, 0, 100, 480)).detections), 1)
        self.assertEqual(self.found(roi=self.roi(0, 0, left, 480)).detections, [])

    def an_object_is_damaged_and_mended(self):
        """Another id, of which one file is cut off."""
        twin = os.path.join(self.root, "twin")
        shutil.copytree(os.path.join(self.made, "mustard"), twin)
        with open(os.path.join(twin, "object.yaml")) as text:
            description = yaml.safe_load(text)
        with open(os.path.join(twin, "cloud.pcd"), "r+b") as file:
            file.truncate(1000)
        small_database.write_description(self.root, "twin", dict(description, id="twin"))
        wait_until(lambda: self.known.status.code == Code.BAD_INPUT, "the damaged object", LEARN_S)
        self.assertIn("'twin'", self.known.status.message)
        self.assertEqual(self.known.ids, ["mustard"])
        self.assertEqual([d.object_id for d in self.found().detections], ["mustard"])
        self.refused(Code.NOT_FOUND, ["'twin'", "cloud.pcd"], "twin")
        damaged = self.model("twin").status
        self.assertEqual(damaged.code, Code.BAD_INPUT, damaged.message)
        self.assertIn("cloud.pcd", damaged.message)
        shutil.copy(os.path.join(self.made, "mustard", "cloud.pcd"), twin)
        answer = self.reload()
        self.assertEqual((answer.status.code, answer.known.ids), (Code.OK, ["mustard", "twin"]), answer.status.message)
        self.wait_for_known("mustard", "twin")

    def an_object_is_deleted(self):
        shutil.rmtree(os.path.join(self.root, "mustard"))
        small_database.write_manifest(self.root)
        self.wait_for_known("twin")
        self.refused(Code.NOT_FOUND, ["'mustard'", "twin"], "mustard")
        self.assertEqual([d.object_id for d in self.found("twin").detections], ["twin"])


if __name__ == "__main__":
    import rostest
    rospy.init_node("test_recogniser")
    rostest.rosrun("object_modelling", "test_recogniser", RecogniserTest)

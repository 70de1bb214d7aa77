#!/usr/bin/python3
"""keyframe_store over its real topics and services: keyframes and masks from topics, previews, every error as a status,
killed and started again."""
import os
import shutil
import sqlite3
import sys
import tempfile
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Pose, PoseWithCovariance
from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support")]
# pylint: disable=wrong-import-position
from node_process import NodeProcess
from synthetic_camera import HEIGHT, SCENE, WIDTH, SyntheticCamera, image_message
from waiting import wait_until
from object_modelling import srv
from object_modelling.msg import (
    Keyframe, KeyframePose, ObjectMask, PoseUpdate, Session, SessionChange, StageMark, Status, StoreState)

SERVICES = {
    "create_session": srv.CreateSession, "list_sessions": srv.ListSessions, "get_session": srv.GetSession,
    "update_session": srv.UpdateSession, "change_session": srv.ChangeSession, "set_session_pose": srv.SetSessionPose, "delete_session": srv.DeleteSession,
    "add_keyframe": srv.AddKeyframe, "get_keyframe": srv.GetKeyframe, "get_encoded_keyframe": srv.GetEncodedKeyframe,
    "update_poses": srv.UpdatePoses,
    "update_masks": srv.UpdateMasks, "export_session": srv.ExportSession, "import_session": srv.ImportSession,
}


def pose_at(x):
    pose = Pose()
    pose.position.x, pose.orientation.w = x, 1.0
    return pose


def exact_pose(keyframe_id, x):
    return KeyframePose(keyframe_id, [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0], [0] * 36)


def keyframe(session_id, index):
    color, depth = SCENE.render(10 * index)
    stamp = rospy.Time(1000 + index)
    camera = SyntheticCamera.__new__(SyntheticCamera)
    camera.stamp, camera.frame_id = stamp, "cam"
    message = Keyframe(session_id=session_id, keyframe_id=index, camera_info=camera.camera_info())
    message.header.stamp, message.header.frame_id = stamp, "cam"
    message.color = image_message(color, "bgr8", stamp, "cam")
    message.depth = image_message(depth.astype(np.float32), "32FC1", stamp, "cam")
    message.session_from_camera.pose = pose_at(0.04 * index)
    return message


class Store:
    """A running node and its interface, under a name of its own."""

    def __init__(self, name, folder, store_path=None):
        self.name = name
        self.path = store_path or os.path.join(folder, "folder to make", "k.sqlite")
        rospy.set_param(name + "/store_path", self.path)
        rospy.set_param(name + "/preview_rate_hz", 20)
        self.keyframes, self.masks = None, None
        self.state, self.cloud, self.path_preview, self.frusta = None, None, None, None
        self._subscribers = [
            rospy.Subscriber(name + "/state", StoreState, lambda m: setattr(self, "state", m)),
            rospy.Subscriber(name + "/cloud", PointCloud2, lambda m: setattr(self, "cloud", m)),
            rospy.Subscriber(name + "/path", Path, lambda m: setattr(self, "path_preview", m)),
            rospy.Subscriber(name + "/frusta", MarkerArray, lambda m: setattr(self, "frusta", m)),
        ]
        self.process = None
        self.start()

    def start(self, **limits):
        # New publishers: rospy counts a listener that was killed until it next writes to it.
        for publisher in (self.keyframes, self.masks):
            if publisher:
                publisher.unregister()
        self.keyframes = rospy.Publisher(self.name + "/keyframe", Keyframe, queue_size=50)
        self.masks = rospy.Publisher(self.name + "/mask", ObjectMask, queue_size=50)
        self.process = NodeProcess("keyframe_store", "__name:=" + self.name, "keyframe:=%s/keyframe" % self.name,
                                   "mask:=%s/mask" % self.name, **limits)
        self.wait(lambda: self.keyframes.get_num_connections() > 0 and self.masks.get_num_connections() > 0)
        for service, kind in SERVICES.items():
            rospy.wait_for_service(self.name + "/" + service, 10)
            setattr(self, service, rospy.ServiceProxy(self.name + "/" + service, kind))

    def close(self):
        if self.process.running():
            self.process.kill()
        for subscriber in self._subscribers:
            subscriber.unregister()

    def wait(self, condition):
        wait_until(condition, "%s to do as the test says" % self.name)


class KeyframeStoreTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.stores = []

    def tearDown(self):
        for store in self.stores:
            store.close()
        shutil.rmtree(self.folder)

    def store(self, name, **more):
        self.stores.append(Store(name, self.folder, **more))
        return self.stores[-1]

    def succeed(self, response):
        self.assertEqual(response.status.code, Status.OK, response.status.message)
        return response

    def test_topics_previews_and_restart(self):
        store = self.store("restarted")
        self.succeed(store.create_session(Session(session_id="s", camera_frame_id="cam")))
        for index in range(3):
            store.keyframes.publish(keyframe("s", index))
        store.wait(lambda: store.state.keyframe_count == 3 and store.frusta and store.path_preview and store.cloud
                   and len(store.path_preview.poses) == 3)
        self.assertEqual((store.state.session_count, store.state.current_session_id), (1, "s"))
        store.wait(lambda: len(store.frusta.markers[0].points) == 3 * 16)
        store.wait(lambda: store.cloud.header.stamp == rospy.Time(1002))
        whole = store.cloud.width
        self.assertGreater(whole, 1000)
        self.assertEqual(store.cloud.header.frame_id, "session")

        # A mask leaves the object alone in the cloud.
        mask = np.zeros((HEIGHT, WIDTH), np.uint8)
        mask[100:140, 140:180] = 255
        store.masks.publish(ObjectMask("s", 1, image_message(mask, "mono8", rospy.Time(0), "")))
        store.wait(lambda: 0 < store.cloud.width < whole / 4)

        store.process.kill()
        store.start()
        session = self.succeed(store.get_session("s"))
        self.assertEqual(list(session.keyframe_ids), [0, 1, 2])
        self.assertEqual(session.session.started, rospy.Time(1000))
        stored = self.succeed(store.get_keyframe("s", 1)).keyframe
        self.assertEqual((stored.header.frame_id, stored.object_mask.width), ("cam", WIDTH))
        self.assertAlmostEqual(stored.session_from_camera.pose.position.x, 0.04)
        # It goes on where it was, previews too.
        store.keyframes.publish(keyframe("s", 3))
        store.wait(lambda: store.state.keyframe_count == 4 and len(store.path_preview.poses) == 4)
        self.assertEqual(store.process.interrupt()[0], 0)

    def test_refusals_are_visible_and_survived(self):
        store = self.store("refusing")
        store.keyframes.publish(keyframe("nobody", 0))
        store.wait(lambda: store.state and store.state.refused_count == 1)
        self.assertEqual(store.state.status.code, Status.NOT_FOUND)
        self.assertIn("nobody", store.state.status.message)
        self.succeed(store.create_session(Session(session_id="s")))
        broken = keyframe("s", 0)
        broken.depth.encoding = "jpeg"
        store.keyframes.publish(broken)
        store.wait(lambda: store.state.refused_count == 2)
        self.assertEqual(store.state.status.code, Status.BAD_INPUT)
        for response, code in (
                (store.create_session(Session(session_id="s")), Status.FAILED_PRECONDITION),
                (store.create_session(Session(session_id="a/b")), Status.INVALID_ARGUMENT),
                (store.get_session("nobody"), Status.NOT_FOUND),
                (store.get_keyframe("s", 5), Status.NOT_FOUND),
                (store.delete_session("nobody"), Status.NOT_FOUND),
                (store.update_poses("s", [PoseUpdate(7, PoseWithCovariance(pose=pose_at(0)))]), Status.NOT_FOUND),
                (store.update_poses("s", [PoseUpdate(0, PoseWithCovariance())]), Status.INVALID_ARGUMENT),
                (store.set_session_pose("s", True, Pose()), Status.INVALID_ARGUMENT)):
            self.assertEqual(response.status.code, code, response.status.message)
            self.assertTrue(response.status.message)
        self.succeed(store.add_keyframe(keyframe("s", 0)))
        self.assertEqual(self.succeed(store.list_sessions()).sessions[0].keyframe_count, 1)

    def test_updates_export_import_delete(self):
        store = self.store("updating")
        self.succeed(store.create_session(Session(session_id="s", object_id="mug", reference_is_object=True)))
        self.succeed(store.add_keyframe(keyframe("s", 0)))
        self.succeed(store.update_poses("s", [PoseUpdate(0, PoseWithCovariance(pose=pose_at(0.5)))]))
        store.wait(lambda: store.path_preview and store.path_preview.poses
                   and store.path_preview.poses[0].pose.position.x == 0.5)
        self.succeed(store.set_session_pose("s", True, pose_at(2)))
        session = self.succeed(store.get_session("s")).session
        self.assertTrue(session.has_model_from_session and session.reference_is_object)
        self.assertEqual((session.model_from_session.position.x, session.object_id), (2, "mug"))
        self.succeed(store.set_session_pose("s", False, Pose()))
        self.assertFalse(store.get_session("s").session.has_model_from_session)

        change = SessionChange(poses=[exact_pose(0, 0.25)], set_refined=True)
        change.session.refined = StageMark("multi_view_icp", "{}")
        change.session.object_id = "not set, so not written"
        self.succeed(store.change_session("s", change))
        store.wait(lambda: store.path_preview.poses[0].pose.position.x == 0.25)
        session = self.succeed(store.get_session("s")).session
        self.assertEqual((session.object_id, session.refined.by), ("mug", "multi_view_icp"))
        change.poses = [exact_pose(0, 9), exact_pose(7, 9)]
        self.assertEqual(store.change_session("s", change).status.code, Status.NOT_FOUND)
        self.assertEqual(self.succeed(store.get_keyframe("s", 0)).keyframe.session_from_camera.pose.position.x, 0.25)
        self.succeed(store.update_poses("s", [PoseUpdate(0, PoseWithCovariance(pose=pose_at(0.5)))]))

        path = os.path.join(self.folder, "exported.sqlite")
        self.succeed(store.export_session("s", path))
        self.assertEqual(store.export_session("s", path).status.code, Status.FAILED_PRECONDITION)
        self.assertEqual(store.import_session(path).status.code, Status.FAILED_PRECONDITION)
        self.succeed(store.delete_session("s"))
        store.wait(lambda: not store.path_preview.poses and store.state.current_session_id == "")
        self.assertEqual(self.succeed(store.import_session(path)).session_id, "s")
        self.assertEqual(self.succeed(store.get_keyframe("s", 0)).keyframe.session_from_camera.pose.position.x, 0.5)
        self.assertNotEqual(store.import_session("/nowhere/x.sqlite").status.code, Status.OK)

    def test_a_store_of_a_newer_schema(self):
        store = self.store("newer")
        self.succeed(store.create_session(Session(session_id="s")))
        store.process.kill()
        with sqlite3.connect(store.path) as database:
            version = database.execute("SELECT version FROM store_schema").fetchone()[0]
            database.execute("UPDATE store_schema SET version = 97")
        database.close()
        store.state = None
        store.start()
        store.wait(lambda: store.state is not None)
        self.assertEqual(store.state.status.code, Status.STORAGE)
        self.assertIn("97", store.list_sessions().status.message)
        self.assertTrue(store.process.running())
        # Once the file can be used again, so can the node.
        with sqlite3.connect(store.path) as database:
            database.execute("UPDATE store_schema SET version = ?", (version,))
        database.close()
        self.assertEqual(self.succeed(store.list_sessions()).sessions[0].session_id, "s")

    def test_a_folder_that_is_not_writable(self):
        store = self.store("unwritable", store_path="/proc/no/k.sqlite")
        response = store.create_session(Session(session_id="s"))
        self.assertEqual(response.status.code, Status.STORAGE, response.status.message)
        self.assertIn("/proc/no", response.status.message)
        self.assertTrue(store.process.running())

    def test_a_full_disk(self):
        store = self.store("full")
        self.succeed(store.create_session(Session(session_id="s")))
        self.assertEqual(store.process.interrupt()[0], 0)
        store.start(max_file_bytes=1000000)
        kept = []
        for index in range(20):
            response = store.add_keyframe(keyframe("s", index))
            if response.status.code != Status.OK:
                break
            kept.append(index)
        self.assertEqual(response.status.code, Status.STORAGE, response.status.message)
        store.keyframes.publish(keyframe("s", len(kept)))
        store.wait(lambda: store.state.refused_count == 1)
        self.assertEqual(store.state.status.code, Status.STORAGE)
        self.assertEqual(list(self.succeed(store.get_session("s")).keyframe_ids), kept)
        # With room again, it goes on where it was.
        store.process.kill()
        store.start()
        self.assertEqual(list(self.succeed(store.get_session("s")).keyframe_ids), kept)
        self.succeed(store.add_keyframe(keyframe("s", len(kept))))

    def test_unknown_parameter(self):
        rospy.set_param("mistaken_store/store_pth", "x")
        code, output = NodeProcess("keyframe_store", "__name:=mistaken_store").wait()
        self.assertEqual(code, 1)
        self.assertIn("store_pth", output)


if __name__ == "__main__":
    rospy.init_node("test_keyframe_store")
    rostest.rosrun("object_modelling", "test_keyframe_store", KeyframeStoreTest)

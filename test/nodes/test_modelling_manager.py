#!/usr/bin/python3
"""The manager's services over ROS, with stand-ins for the nodes that it calls: every wrong order, nodes that are down."""
import os
import signal
import subprocess
import sys
import threading
import unittest

import roslib.packages
import rospy

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support")]
# pylint: disable=wrong-import-position
from fake_nodes import FakeJobs, FakeRecording
from waiting import wait_until
from object_modelling import msg, srv
from object_modelling.msg import ManagerState, Progress
from object_modelling.outcome import Code


class ManagerTest(unittest.TestCase):
    jobs = None  # made once, as action servers cannot be taken down

    @classmethod
    def setUpClass(cls):
        cls.state = ManagerState()
        cls.progress = []
        cls.subscribers = [
            rospy.Subscriber("modelling_manager/state", ManagerState, lambda state: setattr(cls, "state", state)),
            rospy.Subscriber("modelling_manager/progress", Progress, cls.progress.append),
        ]
        ManagerTest.jobs = ManagerTest.jobs or FakeJobs()
        rospy.wait_for_service("modelling_manager/start_session", 20)

    def setUp(self):
        self.recording = FakeRecording()
        self.jobs.reset()
        del self.progress[:]

    def tearDown(self):
        for job in self.jobs.all:
            job.gate.set()
        wait_until(lambda: self.state.state != ManagerState.BUILDING, "the build has ended")
        if self.state.state == ManagerState.RECORDING:
            self.call("stop_session", srv.StopSession)
        self.recording.shutdown()

    @staticmethod
    def call(service, service_type, **fields):
        return rospy.ServiceProxy("modelling_manager/" + service, service_type)(**fields)

    def succeed(self, service, service_type, **fields):
        answer = self.call(service, service_type, **fields)
        self.assertEqual(answer.status.code, Code.OK, answer.status.message)
        return answer

    def refused(self, code, text, service, service_type, **fields):
        status = self.call(service, service_type, **fields).status
        self.assertEqual(status.code, code, status.message)
        self.assertIn(text, status.message)

    def start(self, session_id, **fields):
        return self.succeed("start_session", srv.StartSession, session_id=session_id, **fields)

    def stop(self):
        return self.succeed("stop_session", srv.StopSession)


class RecordingTest(ManagerTest):
    def test_start_and_stop(self):
        self.assertEqual(self.start("s1", object_id="mug").session_id, "s1")
        wait_until(lambda: self.state.state == ManagerState.RECORDING, "recording")
        answer = self.stop()
        self.assertEqual((answer.session_id, answer.keyframe_count, answer.tracked_count), ("s1", 3, 8))
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")

    def test_wrong_orders(self):
        self.refused(Code.FAILED_PRECONDITION, "start_session first", "stop_session", srv.StopSession)
        self.refused(Code.FAILED_PRECONDITION, "nothing to cancel", "cancel", srv.Cancel)
        self.start("s1")
        self.refused(Code.FAILED_PRECONDITION, "'s1' is being recorded", "start_session", srv.StartSession)
        self.refused(Code.FAILED_PRECONDITION, "stop_session before", "build_object", srv.BuildObject, object_id="mug")
        self.stop()
        self.refused(Code.FAILED_PRECONDITION, "'s1'", "stop_session", srv.StopSession)

    def test_bad_ids(self):
        self.refused(Code.INVALID_ARGUMENT, "'a b'", "start_session", srv.StartSession, session_id="a b")
        self.refused(Code.INVALID_ARGUMENT, "'../x'", "start_session", srv.StartSession, object_id="../x")
        self.refused(Code.INVALID_ARGUMENT, "''", "build_object", srv.BuildObject)

    def test_discard(self):
        self.start("s1")
        self.assertEqual(self.succeed("discard_session", srv.DiscardSession).session_id, "s1")
        self.assertEqual(self.recording.sessions, {})
        self.assertEqual(self.recording.recording, "")
        self.refused(Code.NOT_FOUND, "no such session", "discard_session", srv.DiscardSession, session_id="s1")
        self.start("s2")
        del self.recording.sessions["s2"]  # no keyframe yet, so nothing in the store
        self.succeed("discard_session", srv.DiscardSession)
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")

    def test_reason_of_the_tracker_is_passed_on(self):
        self.recording.add("s1")
        self.refused(Code.FAILED_PRECONDITION, "session exists", "start_session", srv.StartSession, session_id="s1")
        self.start("s1", resume=True)
        self.recording.fail_stop = True
        self.refused(Code.STORAGE, "disk full", "stop_session", srv.StopSession)
        wait_until(lambda: self.state.status.code == Code.STORAGE, "the reason in ~state")
        self.assertEqual(self.state.state, ManagerState.IDLE)

    def test_nodes_down_are_named(self):
        self.recording.shutdown()
        self.refused(Code.TIMEOUT, "/camera_tracker/start", "start_session", srv.StartSession)
        self.refused(Code.TIMEOUT, "/keyframe_store/list_sessions", "build_object", srv.BuildObject, object_id="mug")
        self.refused(Code.TIMEOUT, "/keyframe_store/delete_session", "discard_session", srv.DiscardSession,
                     session_id="s")
        self.refused(Code.TIMEOUT, "/model_builder/list_objects", "list_objects", srv.ListObjects)

    def test_tracker_dies_while_recording(self):
        self.start("s1")
        self.recording.shutdown()
        self.refused(Code.TIMEOUT, "/camera_tracker/stop", "stop_session", srv.StopSession)
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")
        self.assertEqual(self.state.status.code, Code.TIMEOUT)

    def test_tracker_restarts_while_recording(self):
        self.start("s1")
        wait_until(lambda: self.state.keyframe_count == 1, "the tracker's report")
        self.recording.publish(False, "")
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")
        self.assertIn("no longer records session 's1'", self.state.status.message)


class BuildTest(ManagerTest):
    def build(self, **fields):
        return self.succeed("build_object", srv.BuildObject, object_id="mug", **fields)

    def test_blocking(self):
        self.recording.add("s1", "mug")
        self.recording.add("s2", "mug")
        answer = self.build(wait=True, name="Mug")
        self.assertEqual(answer.built.object_folder, "/db/mug")
        self.assertEqual([time.stage for time in answer.built.stages], ["refine", "segment", "align", "fuse"])
        self.assertEqual(self.jobs.refine.goals[0].session_ids, ["s1", "s2"])
        self.assertEqual([goal.session_id for goal in self.jobs.segment.goals], ["s1", "s2"])
        self.assertEqual(self.jobs.build.goals[0].name, "Mug")
        wait_until(lambda: self.state.built.object_id == "mug", "the result in ~state")
        wait_until(lambda: self.progress and not self.progress[-1].active, "the end on ~progress")
        self.assertIn("build mug", {report.job for report in self.progress})

    def test_what_was_done_is_done_again_on_request_only(self):
        self.recording.add("s1", "mug")
        self.recording.sessions["s1"].refined.by = "multi_view_icp"
        self.recording.sessions["s1"].segmented.by = "automatic"
        self.recording.add("s2", "mug")
        self.build(wait=True)
        self.assertEqual(self.jobs.refine.goals[0].session_ids, ["s2"])
        self.assertEqual([goal.session_id for goal in self.jobs.segment.goals], ["s2"])
        self.build(wait=True, again=True)
        self.assertEqual(self.jobs.refine.goals[1].session_ids, ["s1", "s2"])
        self.assertEqual([goal.session_id for goal in self.jobs.segment.goals], ["s2", "s1", "s2"])

    def test_progress_tells_stage_and_step(self):
        for session_id in ("s1", "s2", "s3"):
            self.recording.add(session_id, "mug")
        self.recording.sessions["s1"].segmented.by = "by_hand"
        self.jobs.segment.gate.clear()
        self.build()
        self.reported("refine", 0, 0)
        self.reported("segment: as before: s1", 0, 0)
        self.reported("segment: 1 of 2, step", 1, 2)
        self.jobs.segment.started.clear()
        self.jobs.segment.gate.set()
        self.assertTrue(self.jobs.segment.started.wait(10))
        wait_until(lambda: self.progress and not self.progress[-1].active, "the end on ~progress")

    def reported(self, stage, done, total):
        wait_until(lambda: (stage, done, total) in {(report.stage, report.done, report.total) for report in
                                                    list(self.progress)}, stage)

    def test_services_answer_while_a_call_waits(self):
        self.recording.add("s1", "mug")
        self.jobs.refine.gate.clear()
        waiting = [threading.Thread(target=lambda: self.call("build_object", srv.BuildObject, object_id="mug", wait=True))]
        waiting[0].start()
        self.assertTrue(self.jobs.refine.started.wait(10))
        # Nobody offers it: each of these waits for service_wait_s.
        waiting += [threading.Thread(target=lambda: self.call("list_objects", srv.ListObjects)) for _ in range(3)]
        for caller in waiting[1:]:
            caller.start()
        self.refused(Code.FAILED_PRECONDITION, "being built", "build_object", srv.BuildObject, object_id="cup", wait=True)
        self.recording.publish(True, "s9", 5)
        wait_until(lambda: self.state.keyframe_count == 5, "the tracker's report")
        self.succeed("cancel", srv.Cancel)
        for caller in waiting:
            caller.join(10)
            self.assertFalse(caller.is_alive())
        self.recording.publish(False, "s9", 5)

    def test_what_was_left_out_reaches_who_asked(self):
        self.recording.add("s1", "mug")
        self.recording.add("s2", "mug")
        self.jobs.align.status = msg.Status(Code.OK, "left out: session 's2'")
        self.jobs.align.result.left_out_reasons = [msg.SessionLeftOut("s2", "with 's1': too little")]
        self.jobs.build.status = msg.Status(Code.OK, "PARTIAL")
        answer = self.build(wait=True)
        self.assertEqual(self.jobs.align.goals[0].required, msg.AlignGoal.REQUIRE_ONE)
        self.assertEqual(self.jobs.build.goals[0].left_out, [msg.SessionLeftOut("s2", "with 's1': too little")])
        self.assertEqual(answer.status.message, "PARTIAL; left out: session 's2'")
        wait_until(lambda: self.state.status.message == answer.status.message, "the note in ~state")
        self.assertEqual(self.state.status.code, Code.OK)

    def test_all_sessions_can_be_required(self):
        self.recording.add("s1", "mug")
        self.jobs.align.status = msg.Status(Code.NO_RESULT, "all sessions were required")
        self.refused(Code.NO_RESULT, "align: all sessions", "build_object", srv.BuildObject, object_id="mug", wait=True,
                     require_all=True)
        self.assertEqual(self.jobs.align.goals[0].required, msg.AlignGoal.REQUIRE_ALL)
        self.assertEqual(self.jobs.build.goals, [])

    def test_the_last_session_without_object_is_taken(self):
        self.start("s7")
        self.stop()
        self.build(wait=True)
        self.assertEqual(self.jobs.refine.goals[0].session_ids, ["s7"])

    def test_object_without_session(self):
        self.refused(Code.NOT_FOUND, "has no session", "build_object", srv.BuildObject, object_id="plate")
        self.refused(Code.NOT_FOUND, "'nope'", "build_object", srv.BuildObject, object_id="mug", session_ids=["nope"])
        self.recording.add("empty", "cup", 0)
        self.refused(Code.FAILED_PRECONDITION, "'empty'", "build_object", srv.BuildObject, object_id="cup")
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")

    def test_while_building(self):
        self.recording.add("s1", "mug")
        self.jobs.align.gate.clear()
        self.build()
        self.assertTrue(self.jobs.align.started.wait(10))
        wait_until(lambda: self.state.stage == "align", "the stage in ~state")
        self.refused(Code.FAILED_PRECONDITION, "being built", "build_object", srv.BuildObject, object_id="cup")
        self.refused(Code.FAILED_PRECONDITION, "being built", "start_session", srv.StartSession)
        self.refused(Code.FAILED_PRECONDITION, "being built", "discard_session", srv.DiscardSession, session_id="s1")
        self.assertEqual(self.succeed("cancel", srv.Cancel).object_id, "mug")
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle")
        self.assertEqual(self.state.status.code, Code.CANCELLED)
        self.assertIn("'align'", self.state.status.message)
        self.assertEqual(self.jobs.build.goals, [])
        self.jobs.align.gate.set()
        self.build(wait=True)

    def test_cancel_of_a_blocking_call(self):
        self.recording.add("s1", "mug")
        self.jobs.refine.gate.clear()
        answers = []
        caller = threading.Thread(target=lambda: answers.append(
            self.call("build_object", srv.BuildObject, object_id="mug", wait=True)))
        caller.start()
        self.assertTrue(self.jobs.refine.started.wait(10))
        self.succeed("cancel", srv.Cancel)
        caller.join(10)
        self.assertEqual(answers[0].status.code, Code.CANCELLED)

    def test_failed_stage_is_named(self):
        self.recording.add("s1", "mug")
        self.jobs.segment.status = msg.Status(Code.NO_RESULT, "no support plane")
        answer = self.call("build_object", srv.BuildObject, object_id="mug", wait=True)
        self.assertEqual((answer.status.code, answer.status.message), (Code.NO_RESULT, "segment: no support plane"))
        wait_until(lambda: self.state.status.code == Code.NO_RESULT, "the reason in ~state")


class ShutdownTest(ManagerTest):
    def test_ends_at_once_while_a_call_waits_for_a_build(self):
        manager = subprocess.Popen([roslib.packages.find_node("object_modelling", "modelling_manager")[0],
                                    "__name:=short_lived"])
        rospy.wait_for_service("short_lived/build_object", 20)
        self.recording.add("s1", "mug")
        self.jobs.refine.gate.clear()
        answers = []

        def build():
            try:
                answers.append(rospy.ServiceProxy("short_lived/build_object", srv.BuildObject)(object_id="mug", wait=True))
            except rospy.ServiceException as failure:
                answers.append(failure)

        caller = threading.Thread(target=build)
        caller.start()
        self.assertTrue(self.jobs.refine.started.wait(10))
        manager.send_signal(signal.SIGINT)
        self.assertEqual(manager.wait(15), 0)
        caller.join(15)
        self.assertFalse(caller.is_alive())
        if not isinstance(answers[0], rospy.ServiceException):  # the connection closed first
            self.assertEqual(answers[0].status.code, Code.CANCELLED)


class DeadJobTest(ManagerTest):
    """Last, since it takes the refiner down for good."""

    def test_node_dies_while_it_works(self):
        self.recording.add("s1", "mug")
        self.jobs.refine.gate.clear()
        self.succeed("build_object", srv.BuildObject, object_id="mug")
        self.assertTrue(self.jobs.refine.started.wait(10))
        self.jobs.refine.silence()
        wait_until(lambda: self.state.state == ManagerState.IDLE, "idle", 15)
        self.assertEqual(self.state.status.code, Code.TIMEOUT)
        self.assertIn("/refiner/refine", self.state.status.message)


def suite():
    loader = unittest.TestLoader()
    cases = (RecordingTest, BuildTest, ShutdownTest, DeadJobTest)
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in cases)


if __name__ == "__main__":
    import rostest

    rospy.init_node("test_modelling_manager")
    rostest.rosrun("object_modelling", "test_modelling_manager", "test_modelling_manager.suite")

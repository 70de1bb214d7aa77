"""Stand-ins for the nodes that the modelling manager calls, in the test's own process."""
import threading

import actionlib
import rospy

from object_modelling import msg, srv
from object_modelling.outcome import Code


class FakeRecording:
    """camera_tracker and keyframe_store: sessions get three keyframes each."""

    _state = None  # made once: subscribers miss a publisher that goes and comes back

    def __init__(self):
        self.sessions = {}
        self.recording = ""
        self.fail_stop = False
        if FakeRecording._state is None:
            FakeRecording._state = rospy.Publisher("camera_tracker/state", msg.TrackingState, queue_size=5)
        self._services = [
            rospy.Service("camera_tracker/start", srv.StartTracking, self._start),
            rospy.Service("camera_tracker/stop", srv.StopTracking, self._stop),
            rospy.Service("camera_tracker/reset", srv.ResetTracking, self._reset),
            rospy.Service("keyframe_store/get_session", srv.GetSession, self._get),
            rospy.Service("keyframe_store/list_sessions", srv.ListSessions, self._list),
            rospy.Service("keyframe_store/delete_session", srv.DeleteSession, self._delete),
        ]

    def add(self, session_id, object_id="", keyframe_count=3):
        self.sessions[session_id] = msg.Session(
            session_id=session_id, object_id=object_id, keyframe_count=keyframe_count)

    def publish(self, recording, session_id, keyframe_count=0):
        self._state.publish(msg.TrackingState(
            recording=recording, session_id=session_id, keyframe_count=keyframe_count))

    def shutdown(self):
        for service in self._services:
            service.shutdown("end of test")

    def _start(self, request):
        if request.session_id in self.sessions and not request.resume:
            return srv.StartTrackingResponse(status=msg.Status(Code.FAILED_PRECONDITION, "session exists"))
        self.recording = request.session_id or "made_up"
        self.add(self.recording, request.object_id)
        self.publish(True, self.recording, 1)
        return srv.StartTrackingResponse(session_id=self.recording)

    def _stop(self, _):
        if self.fail_stop:
            self.publish(False, self.recording, 3)
            return srv.StopTrackingResponse(status=msg.Status(Code.STORAGE, "disk full"))
        session_id, self.recording = self.recording, ""
        self.publish(False, session_id, 3)
        return srv.StopTrackingResponse(session_id=session_id, keyframe_count=3, frame_count=9, tracked_count=8)

    def _reset(self, _):
        session_id, self.recording = self.recording, ""
        self.publish(False, session_id, 3)
        return srv.ResetTrackingResponse(session_id=session_id)

    def _get(self, request):
        if request.session_id not in self.sessions:
            return srv.GetSessionResponse(
                status=msg.Status(Code.NOT_FOUND, "session '%s' does not exist" % request.session_id))
        return srv.GetSessionResponse(session=self.sessions[request.session_id])

    def _list(self, _):
        return srv.ListSessionsResponse(sessions=list(self.sessions.values()))

    def _delete(self, request):
        if self.sessions.pop(request.session_id, None) is None:
            return srv.DeleteSessionResponse(status=msg.Status(Code.NOT_FOUND, "no such session"))
        return srv.DeleteSessionResponse()


class FakeJob:
    """One action: succeeds at once, or waits on `gate`, or fails with `status`."""

    def __init__(self, name, action_type, result, feedback):
        self.status = msg.Status()
        self.gate = threading.Event()
        self.gate.set()
        self.started = threading.Event()
        self.goals = []
        self.result = result
        self._feedback = feedback
        self._server = actionlib.SimpleActionServer(name, action_type, self._run, auto_start=False)
        self._server.start()

    def _run(self, goal):
        self.goals.append(goal)
        self.started.set()
        self._feedback.stage, self._feedback.done, self._feedback.total = "step", 1, 2
        self._server.publish_feedback(self._feedback)
        while not self.gate.wait(0.02):
            if self._server.is_preempt_requested():
                self.result.status = msg.Status(Code.CANCELLED, "cancelled")
                self._server.set_preempted(self.result)
                return
        self.result.status = self.status
        self._server.set_succeeded(self.result)

    def silence(self):
        """As if the node had died."""
        self._server.action_server.status_timer.shutdown()


class FakeJobs:
    """refiner, segmenter, session_aligner and model_builder. Made once: action servers cannot be taken down."""

    def __init__(self):
        built = msg.BuiltObject(object_id="mug", object_folder="/db/mug", stages=[msg.StageTime("fuse", 1.0)])
        self.refine = FakeJob("refiner/refine", msg.RefineAction, msg.RefineResult(), msg.RefineFeedback())
        self.segment = FakeJob("segmenter/segment_session", msg.SegmentSessionAction, msg.SegmentSessionResult(),
                               msg.SegmentSessionFeedback())
        self.align = FakeJob("session_aligner/align", msg.AlignAction,
                             msg.AlignResult(placements=[msg.SessionPlacement(session_id="s")]), msg.AlignFeedback())
        self.build = FakeJob("model_builder/build", msg.BuildAction, msg.BuildResult(built=built), msg.BuildFeedback())
        self.all = [self.refine, self.segment, self.align, self.build]

    def reset(self):
        for job in self.all:
            job.status = msg.Status()
            job.gate.set()
            job.started.clear()
            job.goals = []
        self.align.result.left_out_reasons = []

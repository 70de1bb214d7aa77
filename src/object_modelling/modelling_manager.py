"""The node that a user calls: start, stop, discard, build, list, cancel. It only calls the others."""
import functools
import threading
import time

import rospy

from object_modelling import build_sequence
from object_modelling import msg, srv
from object_modelling.manager_report import ManagerReport
from object_modelling.modelling_jobs import ModellingJobs
from object_modelling.modelling_state import ModellingState
from object_modelling.outcome import Code, Failure, check_id


def _answers(response_type):
    """Turns what a handler raises into the Status of its response."""

    def decorate(handler):
        @functools.wraps(handler)
        def answer(self, request):
            try:
                return handler(self, request)
            except Failure as failure:
                rospy.logwarn("%s: %s", handler.__name__.strip("_"), failure.message)
                return response_type(status=msg.Status(failure.code, failure.message))
            except Exception as error:  # pylint: disable=broad-except
                rospy.logerr("%s: %s", handler.__name__.strip("_"), error)
                return response_type(status=msg.Status(Code.INTERNAL, "%s: %s" % (type(error).__name__, error)))

        return answer

    return decorate


class ModellingManager:
    """Services of the node. Calls that change the state are taken one after the other (_commands); the state itself is
    guarded by _lock, which is never held while another node is called."""

    def __init__(self, options):
        self._state = ModellingState()
        self._lock = threading.RLock()
        self._commands = threading.Lock()
        self._jobs = ModellingJobs(options)
        self._report = ManagerReport()
        self._report.state(self._state)
        self._tracker = rospy.Subscriber("camera_tracker/state", msg.TrackingState, self._on_tracker, queue_size=1)
        self._services = [
            rospy.Service("~start_session", srv.StartSession, self._start_session),
            rospy.Service("~stop_session", srv.StopSession, self._stop_session),
            rospy.Service("~discard_session", srv.DiscardSession, self._discard_session),
            rospy.Service("~build_object", srv.BuildObject, self._build_object),
            rospy.Service("~list_objects", srv.ListObjects, self._list_objects),
            rospy.Service("~cancel", srv.Cancel, self._cancel),
        ]

    def _on_tracker(self, state):
        with self._lock:
            changed, failure = self._state.tracker_reported(state.recording, state.session_id, state.keyframe_count)
            if failure:
                rospy.logwarn(failure.message)
                self._report.outcome(failure.code, failure.message)
            if changed:
                self._report.state(self._state)

    @_answers(srv.StartSessionResponse)
    def _start_session(self, request):
        with self._commands:
            with self._lock:
                self._state.check_can_start()
            for what, value in (("session id", request.session_id), ("object id", request.object_id)):
                if value:
                    check_id(what, value)
            answer = self._jobs.start_tracking(
                session_id=request.session_id, object_id=request.object_id, resume=request.resume)
            with self._lock:
                self._state.started(answer.session_id)
                self._succeeded()
        rospy.loginfo("recording session '%s'", answer.session_id)
        return srv.StartSessionResponse(session_id=answer.session_id)

    @_answers(srv.StopSessionResponse)
    def _stop_session(self, _):
        with self._commands:
            with self._lock:
                self._state.check_can_stop()
                self._state.ending()
            try:
                answer = self._jobs.stop_tracking()
            except Failure as failure:
                # If the tracker records all the same, its next report says so.
                with self._lock:
                    self._state.tracker_lost()
                    self._failed(failure)
                raise
            with self._lock:
                self._state.stopped(answer.keyframe_count)
                self._succeeded()
        rospy.loginfo("session '%s' has %d keyframes", answer.session_id, answer.keyframe_count)
        return srv.StopSessionResponse(session_id=answer.session_id, keyframe_count=answer.keyframe_count,
                                       frame_count=answer.frame_count, tracked_count=answer.tracked_count)

    @_answers(srv.DiscardSessionResponse)
    def _discard_session(self, request):
        with self._commands:
            with self._lock:
                session_id = self._state.session_to_discard(request.session_id)
                recording = self._state.is_recording(session_id)
            if recording:
                self._end_recording(session_id)
            self._delete(session_id, may_be_missing=recording)
            with self._lock:
                self._state.discarded(session_id)
                self._succeeded()
        return srv.DiscardSessionResponse(session_id=session_id)

    def _delete(self, session_id, may_be_missing):
        """A session that was begun is in the store from its first keyframe on."""
        try:
            self._jobs.delete_session(session_id=session_id)
        except Failure as failure:
            if failure.code != Code.NOT_FOUND or not may_be_missing:
                raise

    def _end_recording(self, session_id):
        with self._lock:
            self._state.ending()
        try:
            self._jobs.reset_tracking()
        except Failure as failure:
            rospy.logwarn("discarding '%s' all the same: %s", session_id, failure.message)
        with self._lock:
            self._state.stopped()

    @_answers(srv.BuildObjectResponse)
    def _build_object(self, request):
        check_id("object id", request.object_id)
        with self._commands, self._lock:
            last_session_id = self._state.session_id
            self._state.begin_build(request.object_id)
            self._succeeded()
        try:
            session_ids = build_sequence.choose_sessions(
                self._jobs, request.object_id, list(request.session_ids), last_session_id)
        except Exception:
            self._end_build(None)
            raise
        outcome = {}
        thread = threading.Thread(target=self._run_build, args=(request, session_ids, outcome), daemon=True)
        thread.start()
        if not request.wait:
            return srv.BuildObjectResponse()
        thread.join()
        if "failure" in outcome:
            raise outcome["failure"]
        return srv.BuildObjectResponse(status=msg.Status(Code.OK, outcome["note"]), built=outcome["built"])

    def _run_build(self, request, session_ids, outcome):
        try:
            outcome["built"], outcome["note"] = self._build(request, session_ids)
        except Failure as failure:
            outcome["failure"] = failure
        except Exception as error:  # pylint: disable=broad-except
            outcome["failure"] = Failure(Code.INTERNAL, "%s: %s" % (type(error).__name__, error))
        self._end_build(outcome)

    def _build(self, request, session_ids):
        rospy.loginfo("building '%s' from %s", request.object_id, ", ".join(session_ids))

        def progress(stage, step, done, total):
            with self._lock:
                if self._state.cancel_requested:
                    raise Failure(Code.CANCELLED, "cancelled on request in stage '%s'" % stage)
                if stage != self._state.stage:
                    self._state.stage = stage
                    self._report.state(self._state)
            self._report.progress(request.object_id, ("%s: %s" % (stage, step)) if step else stage, done, total)

        built, times, note = build_sequence.build(self._jobs, request, session_ids, progress, time.monotonic)
        # The builder tells its own stages apart.
        before = [msg.StageTime(stage, duration_s) for stage, duration_s in times if stage != "build"]
        built.stages = before + list(built.stages)
        if note:
            rospy.logwarn("'%s' is built, but: %s", request.object_id, note)
        return built, note

    def _end_build(self, outcome):
        with self._lock:
            object_id = self._state.object_id
            self._state.end_build()
            failure = (outcome or {}).get("failure")
            if failure:
                self._failed(failure, object_id)
            elif outcome:
                self._report.built(outcome["built"])
                self._report.finished(object_id, Code.OK, outcome["note"])
                self._succeeded(outcome["note"])
            else:
                self._report.state(self._state)

    @_answers(srv.ListObjectsResponse)
    def _list_objects(self, _):
        answer = self._jobs.list_objects()
        return srv.ListObjectsResponse(database_path=answer.database_path, objects=answer.objects)

    @_answers(srv.CancelResponse)
    def _cancel(self, _):
        with self._lock:
            return srv.CancelResponse(object_id=self._state.request_cancel())

    def _succeeded(self, note=""):
        self._report.outcome(Code.OK, note)
        self._report.state(self._state)

    def _failed(self, failure, object_id=None):
        rospy.logwarn(failure.message)
        self._report.outcome(failure.code, failure.message)
        if object_id is not None:
            self._report.finished(object_id, failure.code, failure.message)
        self._report.state(self._state)

"""State machine of the modelling manager; free of ROS and of time.

Recording follows the camera tracker: what it reports is true, whoever started it. Every wrong order is refused with
the state and the way out; no order of calls and reports needs a restart.
"""
from enum import IntEnum

from object_modelling.outcome import Code, Failure


class State(IntEnum):
    """The numbers are those of msg/ManagerState.msg."""

    IDLE = 0
    RECORDING = 1
    BUILDING = 2


class ModellingState:
    """Not thread safe: the caller holds a lock."""

    def __init__(self):
        self.state = State.IDLE
        self.session_id = ""
        self.object_id = ""
        self.keyframe_count = 0
        self.stage = ""
        self.cancel_requested = False
        # Reports of the tracker may be older than our last call: "not recording" counts only once it has reported the
        # session that was started, "recording" not for the session that was just stopped.
        self._confirmed = False
        self._stopped_session_id = None
        self._ending = False  # on a call of ours that has not returned yet

    # Recording

    def check_can_start(self):
        if self.state == State.RECORDING:
            raise Failure(
                Code.FAILED_PRECONDITION,
                "session '%s' is being recorded: stop_session or discard_session first" % self.session_id,
            )
        self._check_not_building("start a session")

    def started(self, session_id):
        if self.is_recording(session_id):
            return  # the tracker's report was faster than its answer
        self.state = State.RECORDING
        self.session_id = session_id
        self.keyframe_count = 0
        self._confirmed = False
        self._stopped_session_id = None

    def check_can_stop(self):
        if self.state != State.RECORDING:
            last = "the last one was '%s'" % self.session_id if self.session_id else "none has been recorded yet"
            raise Failure(
                Code.FAILED_PRECONDITION, "no session is being recorded (%s): start_session first" % last
            )

    def ending(self):
        """The recording is about to be ended on a call: the tracker's report of it is no surprise."""
        self._ending = True

    def stopped(self, keyframe_count=None):
        self._ending = False
        if self.state == State.RECORDING:
            self.state = State.IDLE
            self._stopped_session_id = self.session_id
        if keyframe_count is not None:
            self.keyframe_count = keyframe_count

    def tracker_lost(self):
        """Nothing is recorded any more, unless the tracker comes back and says otherwise. What it stored stays."""
        self.stopped()
        self._stopped_session_id = None
        self._confirmed = False

    def session_to_discard(self, requested):
        """Id of the session to delete: the one asked for, or the current or last one."""
        self._check_not_building("discard a session")
        session_id = requested or self.session_id
        if not session_id:
            raise Failure(
                Code.FAILED_PRECONDITION,
                "no session has been recorded since the manager started: name the session to discard",
            )
        return session_id

    def discarded(self, session_id):
        self._ending = False
        if session_id == self.session_id:
            self.stopped(keyframe_count=0)
            self.session_id = ""

    def is_recording(self, session_id):
        return self.state == State.RECORDING and self.session_id == session_id

    def tracker_reported(self, recording, session_id, keyframe_count):
        """Takes over what the tracker says of itself. Returns (changed, failure): a Failure when a recording ended
        without a call to the manager."""
        if recording:
            if session_id == self._stopped_session_id:
                return False, None
            changed = (self.state != State.RECORDING or self.session_id != session_id
                       or self.keyframe_count != keyframe_count)
            if self.state != State.BUILDING:
                self.state = State.RECORDING
            self.session_id = session_id
            self.keyframe_count = keyframe_count
            self._confirmed = True
            return changed, None
        self._stopped_session_id = None
        if self.state != State.RECORDING or self._ending or not self._confirmed:
            return False, None
        lost = self.session_id
        self.stopped()
        return True, Failure(
            Code.FAILED_PRECONDITION,
            "the camera tracker no longer records session '%s': it was stopped or restarted by somebody else; the "
            "keyframes so far are stored: start_session with resume to go on, or build_object" % lost,
        )

    # Building

    def begin_build(self, object_id):
        if self.state == State.RECORDING:
            raise Failure(
                Code.FAILED_PRECONDITION,
                "session '%s' is being recorded: stop_session before building '%s'" % (self.session_id, object_id),
            )
        self._check_not_building("build '%s'" % object_id)
        self.state = State.BUILDING
        self.object_id = object_id
        self.stage = ""
        self.cancel_requested = False

    def end_build(self):
        self.state = State.IDLE
        self.stage = ""

    def request_cancel(self):
        """Marks the build that runs as cancelled and returns its object id."""
        if self.state != State.BUILDING:
            raise Failure(
                Code.FAILED_PRECONDITION,
                "nothing to cancel: no object is being built (to drop a recording: discard_session)",
            )
        self.cancel_requested = True
        return self.object_id

    def _check_not_building(self, wish):
        if self.state == State.BUILDING:
            raise Failure(
                Code.FAILED_PRECONDITION,
                "cannot %s while object '%s' is being built (stage '%s'): wait for it, or cancel"
                % (wish, self.object_id, self.stage or "beginning"),
            )

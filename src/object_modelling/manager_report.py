"""What the modelling manager publishes: ~state and ~progress, both latched."""
import rospy

from object_modelling import msg


class ManagerReport:
    """Not thread safe, but for progress()."""

    def __init__(self):
        self._state_publisher = rospy.Publisher("~state", msg.ManagerState, queue_size=10, latch=True)
        self._progress_publisher = rospy.Publisher("~progress", msg.Progress, queue_size=10, latch=True)
        self._status = msg.Status()
        self._built = msg.BuiltObject()
        self._last_progress = None

    def outcome(self, code, message):
        self._status = msg.Status(code, message)

    def built(self, built):
        self._built = built

    def state(self, state):
        message = msg.ManagerState(
            state=state.state, session_id=state.session_id, object_id=state.object_id, stage=state.stage,
            keyframe_count=state.keyframe_count, status=self._status, built=self._built)
        message.header.stamp = rospy.Time.now()
        self._state_publisher.publish(message)

    def progress(self, object_id, stage, done, total):
        if (object_id, stage, done, total) == self._last_progress:
            return
        self._last_progress = (object_id, stage, done, total)
        self._publish(msg.Progress(job="build " + object_id, active=True, stage=stage, done=done, total=total))

    def finished(self, object_id, code, text):
        self._last_progress = None
        self._publish(msg.Progress(job="build " + object_id, status=msg.Status(code, text)))

    def _publish(self, message):
        message.header.stamp = rospy.Time.now()
        self._progress_publisher.publish(message)

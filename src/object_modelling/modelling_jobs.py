"""What the modelling manager asks of the other nodes; the `jobs` of build_sequence over ROS."""
from object_modelling.msg import AlignAction, AlignGoal, BuildAction, BuildGoal, RefineAction, RefineGoal
from object_modelling.msg import SegmentSessionAction, SegmentSessionGoal
from object_modelling.node_clients import ActionClient, ServiceClient, check
from object_modelling.srv import DeleteSession, GetSession, ListObjects, ListSessions
from object_modelling.srv import ResetTracking, StartTracking, StopTracking


class ModellingJobs:
    """Thread safe, but for the long jobs, of which one runs at a time."""

    def __init__(self, options):
        def service(name, service_type):
            return ServiceClient(name, service_type, options.service_wait_s, options.call_timeout_s)

        def action(name, action_type):
            return ActionClient(name, action_type, options.service_wait_s, options.job_silence_s)

        self.start_tracking = service("camera_tracker/start", StartTracking)
        self.stop_tracking = service("camera_tracker/stop", StopTracking)
        self.reset_tracking = service("camera_tracker/reset", ResetTracking)
        self.delete_session = service("keyframe_store/delete_session", DeleteSession)
        self.list_objects = service("model_builder/list_objects", ListObjects)
        self._get_session = service("keyframe_store/get_session", GetSession)
        self._list_sessions = service("keyframe_store/list_sessions", ListSessions)
        self._refine = action("refiner/refine", RefineAction)
        self._segment = action("segmenter/segment_session", SegmentSessionAction)
        self._align = action("session_aligner/align", AlignAction)
        self._build = action("model_builder/build", BuildAction)

    def session(self, session_id):
        return self._get_session(session_id=session_id).session

    def list_sessions(self):
        return self._list_sessions().sessions

    def refine(self, session_ids, progress):
        check(self._refine.run(RefineGoal(session_ids=session_ids), progress).status, "refine: ")

    def segment(self, session_id, progress):
        check(self._segment.run(SegmentSessionGoal(session_id=session_id), progress).status, "segment: ")

    def align(self, session_ids, require_all, progress):
        required = AlignGoal.REQUIRE_ALL if require_all else AlignGoal.REQUIRE_ONE
        result = self._align.run(AlignGoal(session_ids=session_ids, required=required), progress)
        check(result.status, "align: ")
        return result.placements, result.left_out_reasons, result.status.message

    def build(self, object_id, name, placements, left_out, replace, progress):
        goal = BuildGoal(object_id=object_id, name=name, placements=placements, left_out=left_out, replace=replace)
        result = self._build.run(goal, progress)
        check(result.status, "build: ")
        return result.built, result.status.message

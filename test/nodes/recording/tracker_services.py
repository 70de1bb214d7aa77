"""The camera tracker's services, for the tests of its nodes."""

import rospy
from object_modelling import srv
from object_modelling.msg import TrackingState

TRACKED = (TrackingState.TRACKING, TrackingState.RELOCALISED)


class Tracker:
    """Services of one namespace."""

    def __init__(self, namespace):
        self.start = self._service(namespace + "/camera_tracker/start", srv.StartTracking)
        self.stop = self._service(namespace + "/camera_tracker/stop", srv.StopTracking)
        self.reset = self._service(namespace + "/camera_tracker/reset", srv.ResetTracking)

    @staticmethod
    def _service(name, kind):
        rospy.wait_for_service(name, 20)
        return rospy.ServiceProxy(name, kind)

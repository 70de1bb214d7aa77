"""The node recognition_adapter: what the recogniser finds, in messages of packages that are there."""
import threading
import time

import actionlib
import rospy
from sensor_msgs.msg import CameraInfo

from object_modelling import msg, parameters, process, srv
from object_modelling.adapters.detections_3d import Detections3D
from object_modelling.adapters.grasping_pipeline import GraspingPipeline
from object_modelling.adapters.recognized_objects import RecognizedObjects
from object_modelling.outcome import Code, Failure

PARAMETERS = {"cam_info_topic": ""}
PIPELINE_PARAMETER = "/cam_info_topic"  # of grasping_pipeline itself
INFO_TIMEOUT_S = 5
SERVICE_TIMEOUT_S = 5


class RecognizedObjectsTopic:
    def __init__(self, _parameters):
        self._converter = RecognizedObjects()
        self._publisher = rospy.Publisher("~recognized_objects", self._converter.message_type, queue_size=5)
        self._subscriber = rospy.Subscriber("recogniser/detections", msg.Detections, self._take, queue_size=5)

    def _take(self, detections):
        self._publisher.publish(self._converter.convert(detections))


class Detections3DTopic:
    def __init__(self, _parameters):
        self._converter = Detections3D()
        # Beside the node's parameters, not among them: what it does not know there ends it when it is started again.
        self._names = rospy.get_name() + "_object_ids"
        self._publisher = rospy.Publisher("~detections_3d", self._converter.message_type, queue_size=5)
        self._info = rospy.Publisher("~vision_info", self._converter.info_type, queue_size=1, latch=True)
        self._lock = threading.Lock()  # each topic has a thread of its own
        self._known = rospy.Subscriber("recogniser/database", msg.KnownObjects, self._learn, queue_size=1)
        self._subscriber = rospy.Subscriber("recogniser/detections", msg.Detections, self._take, queue_size=5)

    def _learn(self, known):
        with self._lock:
            self._tell(known.ids, rospy.Time.now())

    def _tell(self, object_ids, stamp):
        if not self._converter.numbers.add(object_ids):
            return
        rospy.set_param(self._names, self._converter.names())
        info = self._converter.info(msg.Detections().header, self._names)
        info.header.stamp = stamp
        self._info.publish(info)

    def _take(self, detections):
        with self._lock:
            self._tell([d.object_id for d in detections.detections], detections.header.stamp)
            self._publisher.publish(self._converter.convert(detections))


class GraspingPipelineAction:
    def __init__(self, values):
        self._topic = values["cam_info_topic"]
        self._newest = {}  # by topic
        self._subscribers = {}
        self._pipeline = GraspingPipeline(lambda request: self._call("recogniser/recognise", srv.Recognise, request),
                                          lambda object_id: self._call("recogniser/get_object_model",
                                                                       srv.GetObjectModel, object_id),
                                          self._camera_info)
        self._server = actionlib.SimpleActionServer("~estimate_poses", self._pipeline.action_type, self._execute, False)
        self._server.start()

    def _execute(self, goal):
        try:
            self._server.set_succeeded(self._pipeline.answer(goal))
        except Failure as failure:
            rospy.logerr(failure.message)
            self._server.set_aborted(self._pipeline.failed(failure.message), failure.message)

    def _camera_info(self):
        topic = self._topic or rospy.get_param(PIPELINE_PARAMETER, "rgb/camera_info")
        if topic not in self._subscribers:
            self._subscribers[topic] = rospy.Subscriber(topic, CameraInfo,
                                                        lambda info: self._newest.update({topic: info}), queue_size=1)
        end = time.monotonic() + INFO_TIMEOUT_S  # not by ROS time: a paused simulation has none
        while topic not in self._newest and time.monotonic() < end and not process.asked_to_stop():
            time.sleep(0.05)
        if topic not in self._newest:
            raise Failure(Code.FAILED_PRECONDITION, "no camera_info on %s within %g s: set ~cam_info_topic" % (
                rospy.resolve_name(topic), INFO_TIMEOUT_S))
        return self._newest[topic]

    @staticmethod
    def _call(service, service_type, *arguments):
        try:
            rospy.wait_for_service(service, SERVICE_TIMEOUT_S)
            return rospy.ServiceProxy(service, service_type)(*arguments)
        except (rospy.ROSException, rospy.ServiceException) as error:
            raise Failure(Code.FAILED_PRECONDITION, "%s does not answer (%s): is the recogniser running?" % (
                rospy.resolve_name(service), error)) from error


OFFERS = {"topic ~recognized_objects": RecognizedObjectsTopic, "topic ~detections_3d": Detections3DTopic,
          "action ~estimate_poses": GraspingPipelineAction}


def main():
    process.begin("recognition_adapter")
    try:
        values = parameters.read("recognition_adapter", PARAMETERS, rospy.get_param("~", {}))
    except Failure as failure:
        rospy.logfatal(failure.message)
        return 1
    offered = []
    for name, offer in OFFERS.items():
        try:
            offered.append(offer(values))
            rospy.loginfo("%s is offered", name)
        except Failure as failure:
            rospy.logwarn("%s is not offered: %s", name, failure.message)
    if not offered:
        rospy.logwarn("nothing is offered: no package of other messages is found; it is looked for at the start only")
    process.spin()
    return 0

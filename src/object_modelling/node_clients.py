"""Calls of the other nodes' services and actions: each ends in time, and a node that is down is named."""
import threading

import actionlib
from actionlib_msgs.msg import GoalStatusArray
import rospy

from object_modelling.outcome import Code, Failure, NodeDown


def check(status, context=""):
    """Raises what a Status message says unless it is OK."""
    if status.code != Code.OK:
        raise Failure(status.code, context + status.message)


class ServiceClient:
    """One service of another node. Thread safe."""

    def __init__(self, name, service_type, wait_s, timeout_s):
        self._name = rospy.resolve_name(name)
        self._type = service_type
        self._wait_s = wait_s
        self._timeout_s = timeout_s

    def __call__(self, **fields):
        try:
            rospy.wait_for_service(self._name, self._wait_s)
        except rospy.ROSException as error:
            raise NodeDown("service '%s'" % self._name, "not offered within %g s" % self._wait_s) from error
        response = self._call_in_time(fields)
        check(response.status)
        return response

    def _call_in_time(self, fields):
        # rospy waits for ever for the answer of a node that hangs.
        answer = {}

        def call():
            try:
                answer["response"] = rospy.ServiceProxy(self._name, self._type)(**fields)
            except (rospy.ServiceException, rospy.ROSException, OSError) as error:
                answer["error"] = error

        thread = threading.Thread(target=call, daemon=True)
        thread.start()
        thread.join(self._timeout_s)
        if "response" in answer:
            return answer["response"]
        detail = answer.get("error", "no answer within %g s" % self._timeout_s)
        raise NodeDown("service '%s'" % self._name, detail)


class ActionClient:
    """One action of another node; run() blocks until it has ended, was cancelled, or its node has gone."""

    POLL_S = 0.05

    def __init__(self, name, action_type, wait_s, silence_s):
        self._name = rospy.resolve_name(name)
        self._wait_s = wait_s
        self._silence_s = silence_s
        self._client = actionlib.SimpleActionClient(name, action_type)
        # An action server publishes its status all the time: silence means that it is gone.
        self._last_sign = rospy.get_time()
        self._status = rospy.Subscriber(name + "/status", GoalStatusArray, self._on_status, queue_size=1)

    def _on_status(self, _):
        self._last_sign = rospy.get_time()

    def run(self, goal, progress):
        """Result of the goal. `progress` is called often and may raise Failure: the goal is then cancelled, and what
        was raised goes on once the server has let go."""
        if not self._client.wait_for_server(rospy.Duration(self._wait_s)):
            raise NodeDown("action '%s'" % self._name, "not offered within %g s" % self._wait_s)
        latest = {}
        self._last_sign = rospy.get_time()
        self._client.send_goal(goal, feedback_cb=lambda feedback: latest.update(feedback=feedback))
        try:
            self._follow(latest, progress)
        except Failure:
            self._client.cancel_goal()
            self._client.wait_for_result(rospy.Duration(self._silence_s))
            result = self._client.get_result()
            if result is None or result.status.code != Code.OK:
                raise
            return result  # it had ended before the cancel reached it
        result = self._client.get_result()
        if result is None:
            raise NodeDown("action '%s'" % self._name,
                           self._client.get_goal_status_text() or "its node was restarted while it worked")
        return result

    def _follow(self, latest, progress):
        while not self._client.wait_for_result(rospy.Duration(self.POLL_S)):
            if rospy.is_shutdown():
                raise Failure(Code.CANCELLED, "the manager is being shut down")
            feedback = latest.get("feedback")
            if feedback is None:
                progress("", 0, 0)
            else:
                progress(feedback.stage, feedback.done, feedback.total)
            if rospy.get_time() - self._last_sign > self._silence_s:
                raise NodeDown("action '%s'" % self._name, "silent for %g s while it worked" % self._silence_s)

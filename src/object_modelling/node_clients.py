"""Calls of the other nodes' services and actions: each ends in time, and a node that is down is named."""
import threading
import time

import actionlib
from actionlib import CommState
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
        # Not SimpleActionClient: it drops what a server reports before its send_goal() has returned, and then waits for
        # ever for the end of a goal that ended at once.
        self._client = actionlib.ActionClient(name, action_type)
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
        handle = self._client.send_goal(goal, feedback_cb=lambda _, feedback: latest.update(feedback=feedback))
        try:
            self._follow(handle, latest, progress)
        except Failure:
            handle.cancel()
            self._wait_for_end(handle, self._silence_s)
            result = handle.get_result()
            if result is None or result.status.code != Code.OK:
                raise
            return result  # it had ended before the cancel reached it
        result = handle.get_result()
        if result is None:
            raise NodeDown("action '%s'" % self._name,
                           handle.get_goal_status_text() or "its node was restarted while it worked")
        return result

    @staticmethod
    def _wait_for_end(handle, timeout_s):
        end = time.monotonic() + timeout_s
        # A cancel that comes late takes a goal out of DONE again; its result stays.
        while handle.get_comm_state() != CommState.DONE and handle.get_result() is None:
            if time.monotonic() > end:
                return False
            time.sleep(0.005)
        return True

    def _follow(self, handle, latest, progress):
        sent = rospy.get_time()
        while not self._wait_for_end(handle, self.POLL_S):
            if rospy.is_shutdown():
                raise Failure(Code.CANCELLED, "the manager is being shut down")
            feedback = latest.get("feedback")
            if feedback is None:
                progress("", 0, 0)
            else:
                progress(feedback.stage, feedback.done, feedback.total)
            if rospy.get_time() - self._last_sign > self._silence_s:
                raise NodeDown("action '%s'" % self._name, "silent for %g s while it worked" % self._silence_s)
            waiting = handle.get_comm_state() == CommState.WAITING_FOR_GOAL_ACK
            if waiting and rospy.get_time() - sent > self._silence_s:
                raise NodeDown("action '%s'" % self._name, "did not take the goal within %g s" % self._silence_s)

"""Waits of the nodes' tests: for what is to happen, never for a fixed time, and by the wall clock."""
import time

import rospy

POLL_S = 0.02


def wait_until(condition, what, timeout_s=10):
    """Returns once `condition()` holds; AssertionError that names `what` after `timeout_s`."""
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("waited %g s for %s" % (timeout_s, what))
        time.sleep(POLL_S)


def listen(topic, kind, callback):
    """A subscriber that its publisher is connected to."""
    subscriber = rospy.Subscriber(topic, kind, callback)
    wait_until(lambda: subscriber.get_num_connections() > 0, "a publisher of " + topic)
    return subscriber

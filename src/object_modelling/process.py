"""A node's beginning and end: stopped from its own loop by Ctrl-C, kill, or rosnode kill."""
import signal
import time

import rospy

_asked_to_stop = []


def begin(name):
    # Not within rospy's own handler: there a signal that comes while it logs waits for ever.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: _asked_to_stop.append(True))
    rospy.init_node(name, disable_signals=True)


def asked_to_stop():
    return bool(_asked_to_stop) or rospy.is_shutdown()


def spin():
    """Returns when the node is asked to stop."""
    while not asked_to_stop():
        time.sleep(0.1)
    rospy.signal_shutdown("asked to stop")

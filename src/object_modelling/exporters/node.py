"""The node exporter: object models for other programs, by a service."""
import os
import threading

import rospy

from object_modelling import msg, parameters, process, srv
from object_modelling.exporters import command
from object_modelling.outcome import Code, Failure

PARAMETERS = {"database_path": ""}


def database_folder(path):
    """As for model_builder: `~/` is the home folder; empty: objects in the folder object_modelling of ROS_HOME."""
    if path:
        return os.path.expanduser(path)
    home = os.environ.get("ROS_HOME") or os.path.join(os.path.expanduser("~"), ".ros")
    return os.path.join(home, "object_modelling", "objects")


class Exporter:
    """One export at a time."""

    def __init__(self, database_path):
        self._database_path = database_folder(database_path)
        self._lock = threading.Lock()
        self._service = rospy.Service("~export", srv.ExportObjects, self._export)

    def _export(self, request):
        if not self._lock.acquire(blocking=False):
            return self._answer(Code.FAILED_PRECONDITION, "another export is going on: wait for its answer")
        try:
            folder, notes = command.export_objects(self._database_path, request.object_ids, request.format,
                                                   request.folder)
            for note in notes:
                rospy.logwarn(note)
            return self._answer(Code.OK, "; ".join(notes), folder)
        except Failure as failure:
            rospy.logerr(failure.message)
            return self._answer(failure.code, failure.message)
        finally:
            self._lock.release()

    @staticmethod
    def _answer(code, message, folder=""):
        return srv.ExportObjectsResponse(status=msg.Status(code=code, message=message), folder=folder)


def main():
    process.begin("exporter")
    try:
        values = parameters.read("exporter", PARAMETERS, rospy.get_param("~", {}))
    except Failure as failure:
        rospy.logfatal(failure.message)
        return 1
    exporter = Exporter(values["database_path"])
    rospy.loginfo("exporter: %s", values)
    process.spin()
    del exporter
    return 0

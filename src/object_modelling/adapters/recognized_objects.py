"""object_recognition_msgs/RecognizedObjectArray."""
import json

from geometry_msgs.msg import Point

from object_modelling.adapters import foreign, poses

PACKAGE = foreign.Package(["object_recognition_msgs"], "install it: apt-get install ros-$ROS_DISTRO-object-recognition-"
                          "msgs, or put github.com/wg-perception/object_recognition_msgs into the workspace")
TYPES = {
    "RecognizedObjectArray": ["header", "objects"],
    "RecognizedObject": ["header", "type", "confidence", "bounding_mesh", "pose"],
    "ObjectType": ["key", "db"],
}


class RecognizedObjects:
    """Converts object_modelling/Detections. Raises foreign.Package's Failure where the messages are not there."""

    def __init__(self):
        self._types = PACKAGE.types(TYPES)
        self.message_type = self._types["RecognizedObjectArray"]

    def convert(self, detections):
        objects = [self._object(detection, detections.header) for detection in detections.detections]
        return self.message_type(header=detections.header, objects=objects)

    def _object(self, detection, header):
        """The mesh is the box, in the frame of the header."""
        found = self._types["RecognizedObject"](header=header, confidence=detection.confidence_ratio)
        found.type.key = detection.object_id
        found.type.db = json.dumps({"type": "object_modelling", "content_hash": detection.content_hash})
        found.pose.header, found.pose.pose = header, detection.pose
        found.bounding_mesh.vertices = [Point(*corner) for corner in poses.corners(detection)]
        triangle_type = _element_type(found.bounding_mesh, "triangles")
        found.bounding_mesh.triangles = [triangle_type(vertex_indices=list(t)) for t in poses.BOX_TRIANGLES]
        return found


def _element_type(message, field):
    """Class of an array's elements; their package need not be known."""
    from roslib.message import get_message_class  # pylint: disable=import-outside-toplevel
    kind = message._slot_types[message.__slots__.index(field)]  # pylint: disable=protected-access
    return get_message_class(kind.split("[")[0])

"""vision_msgs/Detection3DArray, with VisionInfo for the names of its numbers."""
import re

from object_modelling.adapters import foreign, poses

PACKAGE = foreign.Package(["vision_msgs"], "install it: apt-get install ros-$ROS_DISTRO-vision-msgs, or put "
                          "github.com/ros-perception/vision_msgs (branch noetic-devel) into the workspace")
TYPES = {
    "Detection3DArray": ["header", "detections"],
    "Detection3D": ["header", "results", "bbox"],
    "ObjectHypothesisWithPose": ["id", "score", "pose"],
    "VisionInfo": ["header", "method", "database_location", "database_version"],
}


class Numbers:
    """A number for each object: the digits that its id begins with unless they are another's, else the smallest free
    one. An object keeps its number."""

    def __init__(self):
        self.by_id = {}

    def add(self, object_ids):
        """Whether any of them is new."""
        new = sorted(set(object_ids) - set(self.by_id))
        own = [self._own(object_id) for object_id in new]
        taken = set(self.by_id.values())
        for object_id, number in zip(new, own):
            if number is not None and own.count(number) == 1 and number not in taken:
                self.by_id[object_id] = number
        reserved = taken | {number for number in own if number is not None}
        for object_id in new:
            if object_id not in self.by_id:
                self.by_id[object_id] = next(n for n in range(1, 2 + len(reserved) + len(new)) if n not in reserved)
                reserved.add(self.by_id[object_id])
        return bool(new)

    @staticmethod
    def _own(object_id):
        digits = re.match(r"\d{1,9}(?!\d)", object_id)
        return int(digits.group()) if digits else None


class Detections3D:
    """Converts object_modelling/Detections. Raises foreign.Package's Failure where the messages are not there."""

    def __init__(self):
        self._types = PACKAGE.types(TYPES)
        self.message_type = self._types["Detection3DArray"]
        self.info_type = self._types["VisionInfo"]
        self.numbers = Numbers()
        self._version = 0

    def convert(self, detections):
        self.numbers.add(detection.object_id for detection in detections.detections)
        return self.message_type(header=detections.header, detections=[
            self._detection(detection, detections.header) for detection in detections.detections])

    def info(self, header, names_parameter):
        """`names_parameter`: where on the parameter server the object ids are, by number."""
        self._version += 1
        return self.info_type(header=header, method="object_modelling", database_location=names_parameter,
                              database_version=self._version)

    def names(self):
        """Object ids by number; keys of the parameter server are texts."""
        return {str(number): object_id for object_id, number in self.numbers.by_id.items()}

    def _detection(self, detection, header):
        hypothesis = self._types["ObjectHypothesisWithPose"](
            id=self.numbers.by_id[detection.object_id], score=detection.confidence_ratio, pose=detection.pose)
        found = self._types["Detection3D"](header=header, results=[hypothesis])
        found.bbox.center = poses.pose_message(poses.camera_from_box(detection))
        found.bbox.size = detection.size_m
        return found

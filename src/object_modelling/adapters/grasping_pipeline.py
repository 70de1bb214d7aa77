"""Action GenericImgProcAnnotator, by which TU Wien's grasping_pipeline calls detectors and pose estimators."""
import numpy as np
from sensor_msgs.msg import RegionOfInterest

from object_modelling import srv
from object_modelling.adapters import foreign, images, poses, silhouettes
from object_modelling.outcome import Code, Failure

PACKAGE = foreign.Package(["robokudo_msgs", "object_detector_msgs"], "put the robokudo_msgs that your grasping_pipeline "
                          "uses into the workspace (github.com/v4r-tuwien)")
TYPES = {
    "GenericImgProcAnnotatorAction": ["action_goal", "action_result"],
    "GenericImgProcAnnotatorGoal": ["rgb", "depth", "bb_detections", "mask_detections", "class_names", "description"],
    "GenericImgProcAnnotatorResult": ["success", "pose_results", "class_names", "class_confidences", "image"],
}


class Region:
    """Where an object was found by somebody else; without a name any object counts."""

    def __init__(self, name, contains):
        self.name = name
        self._contains = contains

    def fits(self, detection, pixel):
        return self.name in ("", detection.object_id) and self._contains(pixel)


def regions_of(goal):
    """One for each mask, else for each box of the goal, with the class name of the same place."""
    given = goal.mask_detections or goal.bb_detections
    if goal.class_names and given and len(goal.class_names) != len(given):
        raise Failure(Code.INVALID_ARGUMENT, "%d class_names are given for %d detections: give one for each, or none" % (
            len(goal.class_names), len(given)))
    contains = _in_mask if goal.mask_detections else _in_box
    names = goal.class_names or [""] * len(given)
    return [Region(name, contains(region)) for name, region in zip(names, given)]


def _in_mask(message):
    mask = images.mask(message)

    def contains(pixel):
        u, v = np.round(pixel).astype(int)
        return 0 <= v < mask.shape[0] and 0 <= u < mask.shape[1] and bool(mask[v, u])
    return contains


def _in_box(box):
    return lambda pixel: (box.x_offset <= pixel[0] < box.x_offset + box.width and
                          box.y_offset <= pixel[1] < box.y_offset + box.height)


def choose(detections, goal, camera_matrix):
    """Of each region the most confident detection whose centre falls into it, no detection twice; without regions all
    that the class names allow."""
    regions = regions_of(goal)
    if not regions:
        return [d for d in detections if not goal.class_names or d.object_id in goal.class_names]
    chosen = []
    for region in regions:
        for detection in detections:  # the most confident first
            center = camera_matrix @ poses.camera_from_box(detection)[:3, 3]
            if not any(detection is other for other in chosen) and region.fits(detection, center[:2] / center[2]):
                chosen.append(detection)
                break
    return chosen


def matrix_of(info):
    """3x3 of rectified images: P where there is one, else K."""
    if info.P[0] > 0:
        return np.reshape(info.P, (3, 4))[:, :3]
    return np.reshape(info.K, (3, 3))


class GraspingPipeline:
    """Answers goals. `recognise` and `object_model` call the services of the recogniser; `camera_info` gives the newest
    one. Raises foreign.Package's Failure where the messages are not there."""

    def __init__(self, recognise, object_model, camera_info):
        self._types = PACKAGE.types(TYPES)
        self.action_type = self._types["GenericImgProcAnnotatorAction"]
        self.result_type = self._types["GenericImgProcAnnotatorResult"]
        self._recognise = recognise
        self._object_model = object_model
        self._camera_info = camera_info
        self._surfaces = {}  # by content hash

    def answer(self, goal):
        """Result of a goal; Failure says why there is none."""
        info = self._camera_info()
        camera_matrix = matrix_of(info)
        depth_m = images.depth_m(goal.depth)
        response = self._recognise(srv.RecogniseRequest(color=goal.rgb, depth=goal.depth, camera_info=info))
        if response.status.code != Code.OK:
            raise Failure(response.status.code, response.status.message)
        chosen = choose(response.detections.detections, goal, camera_matrix)
        labels = silhouettes.label_image([self._surface(d) for d in chosen], [poses.matrix(d.pose.pose) for d in chosen],
                                         camera_matrix, depth_m)
        return self._result(chosen, labels, goal.rgb.header)

    def failed(self, message):
        return foreign.fill(self.result_type(success=False), result_feedback=message)

    def _result(self, chosen, labels, header):
        result = self.result_type(
            success=bool(chosen), pose_results=[d.pose.pose for d in chosen], class_names=[d.object_id for d in chosen],
            class_confidences=[d.confidence_ratio for d in chosen], image=images.label_message(labels, header))
        boxes = [silhouettes.box_of(labels == index) for index in range(len(chosen))]
        return foreign.fill(
            result, result_feedback="" if chosen else "nothing that is known was found",
            bounding_boxes=[RegionOfInterest(x_offset=x, y_offset=y, width=w, height=h) for x, y, w, h in boxes])

    def _surface(self, detection):
        if detection.content_hash not in self._surfaces:
            response = self._object_model(detection.object_id)
            if response.status.code != Code.OK:
                raise Failure(response.status.code, response.status.message)
            self._surfaces[detection.content_hash] = silhouettes.Surface(response.object.mesh)
        return self._surfaces[detection.content_hash]

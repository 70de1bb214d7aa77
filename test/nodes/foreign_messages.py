"""Makes Python classes of messages whose packages are not installed, with the field definitions that those have."""
import os
import subprocess
import sys

import rospkg

ACTION_PARTS = {
    "ActionGoal": "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\n{0}Goal goal\n",
    "ActionResult": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{0}Result result\n",
    "ActionFeedback": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{0}Feedback feedback\n",
    "Action": "{0}ActionGoal action_goal\n{0}ActionResult action_result\n{0}ActionFeedback action_feedback\n",
}

SHAPES = {
    "MeshTriangle": "uint32[3] vertex_indices\n",
    "Mesh": "MeshTriangle[] triangles\ngeometry_msgs/Point[] vertices\n",
}
OBJECT_RECOGNITION = {
    "ObjectType": "string key\nstring db\n",
    "RecognizedObject": "std_msgs/Header header\nObjectType type\nfloat32 confidence\n"
                        "sensor_msgs/PointCloud2[] point_clouds\nshape_msgs/Mesh bounding_mesh\n"
                        "geometry_msgs/Point[] bounding_contours\ngeometry_msgs/PoseWithCovarianceStamped pose\n",
    "RecognizedObjectArray": "std_msgs/Header header\nRecognizedObject[] objects\nfloat32[] cooccurrence\n",
}
VISION = {
    "BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n",
    "ObjectHypothesisWithPose": "int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose\n",
    "Detection3D": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\n"
                   "sensor_msgs/PointCloud2 source_cloud\n",
    "Detection3DArray": "std_msgs/Header header\nDetection3D[] detections\n",
    "VisionInfo": "std_msgs/Header header\nstring method\nstring database_location\nint32 database_version\n",
}
# Of ROS 2 and its backports: the hypothesis is a message of its own.
OTHER_VISION = dict(VISION, ObjectHypothesis="string class_id\nfloat64 score\n",
                    ObjectHypothesisWithPose="ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n")
GENERIC_ANNOTATOR = (
    "sensor_msgs/Image rgb\nsensor_msgs/Image depth\nsensor_msgs/RegionOfInterest[] bb_detections\n"
    "sensor_msgs/Image[] mask_detections\nstring[] class_names\nstring description\n",
    "bool success\nstring result_feedback\nsensor_msgs/RegionOfInterest[] bounding_boxes\nint32[] class_ids\n"
    "string[] class_names\nfloat32[] class_confidences\nsensor_msgs/Image image\ngeometry_msgs/Pose[] pose_results\n"
    "string[] descriptions\n",
    "string feedback\n")


def action(name, goal, result, feedback):
    """The seven messages of an action."""
    messages = {name + "Goal": goal, name + "Result": result, name + "Feedback": feedback}
    messages.update({name + part: text.format(name) for part, text in ACTION_PARTS.items()})
    return messages


def make(folder, package, definitions, beside=()):
    """Writes the package into `folder`, to be put on PYTHONPATH. `beside`: packages made there before that it needs."""
    texts = os.path.join(folder, "definitions", package)
    out = os.path.join(folder, package, "msg")
    os.makedirs(texts)
    os.makedirs(out)
    for name, text in definitions.items():
        with open(os.path.join(texts, name + ".msg"), "w") as file:
            file.write(text)
    places = {name: os.path.join(rospkg.RosPack().get_path(name), "msg")
              for name in ("std_msgs", "geometry_msgs", "sensor_msgs", "actionlib_msgs")}
    places.update({name: os.path.join(folder, "definitions", name) for name in (package, *beside)})
    includes = [word for name, place in places.items() for word in ("-I", "%s:%s" % (name, place))]
    generate = ("import sys, genpy.genpy_main as m, genpy.generator as g; "
                "m.genmain(['genmsg'] + sys.argv[1:], 'genmsg', g.MsgGenerator())")
    command = [sys.executable, "-c", generate, "-p", package, "-o", out, *includes]
    files = [os.path.join(texts, name + ".msg") for name in definitions]
    subprocess.run(command + files, check=True, timeout=120)
    subprocess.run(command[:3] + ["--initpy", "-p", package, "-o", out], check=True, timeout=60)
    open(os.path.join(folder, package, "__init__.py"), "w").close()


def make_all(folder):
    make(folder, "shape_msgs", SHAPES)
    make(folder, "object_recognition_msgs", OBJECT_RECOGNITION, ["shape_msgs"])
    make(folder, "vision_msgs", VISION)
    make(folder, "robokudo_msgs", action("GenericImgProcAnnotator", *GENERIC_ANNOTATOR))

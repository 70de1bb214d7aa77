"""Has the recogniser find known objects in the images of a scene; prints what it finds and draws it."""
import argparse
import json
import os
import sys
import time

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image

from object_modelling import msg, srv
from object_modelling.adapters import poses, silhouettes
from object_modelling.outcome import Code, Failure

EXIT_OK, EXIT_NOTHING, EXIT_USAGE, EXIT_FAILED = 0, 1, 2, 3
EPILOG = "exit codes: 0 something was found in each image, 1 it was not, 2 wrong usage, 3 the recogniser did not answer"
COLOURS_BGR = [(60, 220, 60), (255, 160, 40), (60, 60, 255), (40, 220, 255), (255, 80, 255)]
FRAME_ID = "camera_rgb_optical_frame"
POLL_S = 0.1


def parse(arguments):
    parser = argparse.ArgumentParser(prog="recognition_demo", description=__doc__, epilog=EPILOG)
    parser.add_argument("scene", help="scene folder in the layout of BOP data sets")
    parser.add_argument("--out", default=".", help="folder of the pictures (%(default)s)")
    parser.add_argument("--wait-for", nargs="*", default=[], metavar="ID", help="objects that must be learnt first")
    parser.add_argument("--namespace", default="object_modelling", help="namespace of the nodes (%(default)s)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds until they are learnt (%(default)s)")
    options = parser.parse_args(arguments)
    if not os.path.isfile(os.path.join(options.scene, "scene_camera.json")):
        parser.error("'%s' is no scene of a BOP data set: scene_camera.json is missing" % options.scene)
    return options


class SceneImage:
    """One image of a scene; messages as a camera would send them."""

    def __init__(self, scene, number, camera):
        name = "%06d" % number
        self.number = number
        self.camera_matrix = np.reshape(camera["cam_K"], (3, 3))
        self.color = self._read(os.path.join(scene, "rgb", name), cv2.IMREAD_COLOR)
        self.depth = self._read(os.path.join(scene, "depth", name), cv2.IMREAD_UNCHANGED)
        self.depth_m = (self.depth * (0.001 * camera["depth_scale"])).astype(np.float32)

    @staticmethod
    def _read(path, flags):
        for extension in (".jpg", ".png"):
            image = cv2.imread(path + extension, flags) if os.path.isfile(path + extension) else None
            if image is not None:
                return image
        raise Failure(Code.BAD_INPUT, "%s.jpg or .png cannot be read" % path)

    def messages(self, stamp):
        """Fields of a RecogniseRequest."""
        info = CameraInfo(width=self.color.shape[1], height=self.color.shape[0], K=self.camera_matrix.ravel().tolist())
        messages = {"color": self._message(self.color, "bgr8"), "depth": self._message(self.depth_m, "32FC1"),
                    "camera_info": info}
        for message in messages.values():
            message.header.stamp, message.header.frame_id = stamp, FRAME_ID
        return messages

    @staticmethod
    def _message(image, encoding):
        return Image(height=image.shape[0], width=image.shape[1], encoding=encoding, step=image.strides[0],
                     data=image.tobytes())


def read_scene(folder):
    with open(os.path.join(folder, "scene_camera.json")) as text:
        cameras = {int(number): camera for number, camera in json.load(text).items()}
    return [SceneImage(folder, number, cameras[number]) for number in sorted(cameras)]


def draw(image, detections, surfaces):
    """The colour image with the outline of each pose, and id and confidence beside it."""
    picture = image.color.copy()
    for index, (detection, surface) in enumerate(zip(detections, surfaces)):
        colour = COLOURS_BGR[index % len(COLOURS_BGR)]
        depth = silhouettes.draw_depth(surface, poses.matrix(detection.pose.pose), image.camera_matrix,
                                       image.depth_m.shape)
        outline = np.isfinite(depth).astype(np.uint8)
        contours = cv2.findContours(outline, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[-2]
        cv2.drawContours(picture, contours, -1, colour, 2, cv2.LINE_AA)
        x, y, _, _ = silhouettes.box_of(outline)
        text = "%s %.2f" % (detection.object_id, detection.confidence_ratio)
        place = (int(x), max(14, int(y) - 8))
        for width, shade in ((4, (0, 0, 0)), (1, colour)):
            cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, shade, width, cv2.LINE_AA)
    return picture


class RecognitionDemo:
    def __init__(self, options, say=print):
        self._options = options
        self._say = say
        self._root = "/%s/recogniser/" % options.namespace.strip("/")
        self._known = None
        self._surfaces = {}  # by object id
        self._subscriber = rospy.Subscriber(self._root + "database", msg.KnownObjects, self._on_known)

    def run(self):
        """Number of images in which nothing was found."""
        self._wait_until_learnt()
        os.makedirs(self._options.out, exist_ok=True)
        without = 0
        for image in read_scene(self._options.scene):
            found = self._call("recognise", srv.Recognise, **image.messages(rospy.Time.now())).detections
            self._report(image, found)
            without += not found.detections
        return without

    def _on_known(self, known):
        self._known = known

    def _wait_until_learnt(self):
        end = time.monotonic() + self._options.timeout
        wanted = set(self._options.wait_for)
        while self._known is None or not self._known.ids or not wanted <= set(self._known.ids):
            if time.monotonic() > end:
                known = "nothing is heard of it" if self._known is None else "it knows %s; %s" % (
                    ", ".join(self._known.ids) or "none", self._known.status.message)
                raise Failure(Code.TIMEOUT, "the recogniser %s does not know %s after %g s: %s" % (
                    self._root, ", ".join(sorted(wanted)) or "any object", self._options.timeout, known))
            time.sleep(POLL_S)
        self._say("known: %s" % ", ".join(self._known.ids))

    def _call(self, service, service_type, **fields):
        try:
            rospy.wait_for_service(self._root + service, self._options.timeout)
            answer = rospy.ServiceProxy(self._root + service, service_type)(**fields)
        except (rospy.ROSException, rospy.ServiceException) as error:
            raise Failure(Code.FAILED_PRECONDITION, "%s%s: %s" % (self._root, service, error)) from error
        if answer.status.code != Code.OK:
            raise Failure(answer.status.code, "%s: %s" % (service, answer.status.message))
        return answer

    def _surface(self, object_id):
        if object_id not in self._surfaces:
            model = self._call("get_object_model", srv.GetObjectModel, object_id=object_id).object
            self._surfaces[object_id] = silhouettes.Surface(model.mesh)
        return self._surfaces[object_id]

    def _report(self, image, found):
        self._say("image %d, %.1f s: %s" % (image.number, found.seconds, "" if found.detections else "nothing known"))
        for detection in found.detections:
            place = detection.pose.pose.position
            sigma_mm = 1e3 * np.sqrt(np.diag(np.reshape(detection.pose.covariance, (6, 6)))[:3].max())
            self._say("  %-16s confidence %.2f at (%.3f, %.3f, %.3f) m, sigma %.1f mm, %3.0f %% visible" % (
                detection.object_id, detection.confidence_ratio, place.x, place.y, place.z, sigma_mm,
                100 * detection.visible_ratio))
        path = os.path.join(self._options.out, "recognised_%06d.png" % image.number)
        picture = draw(image, found.detections, [self._surface(d.object_id) for d in found.detections])
        if not cv2.imwrite(path, picture):
            raise Failure(Code.STORAGE, "%s cannot be written" % path)
        self._say("  picture: %s" % path)


def main(arguments):
    options = parse(arguments)
    rospy.init_node("recognition_demo", anonymous=True, disable_signals=True)
    try:
        without = RecognitionDemo(options, lambda line: print(line, flush=True)).run()
    except Failure as failure:
        print("recognition_demo: %s" % failure.message, file=sys.stderr)
        return EXIT_FAILED
    except KeyboardInterrupt:
        return EXIT_FAILED
    return EXIT_NOTHING if without else EXIT_OK

"""A camera that does not exist: renders two textured planes from a moving camera and publishes what a driver would,
with any fault that a test asks for. Needs numpy only."""
import os
import sys
import threading
import time

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
# pylint: disable=wrong-import-position
from waiting import wait_until
from object_modelling.msg import TrackingState

WIDTH, HEIGHT, FOCAL = 320, 240, 280.0
FRAME_PERIOD_S = 1.0 / 30


def _texture(size, seed):
    """Blobs of several sizes in colour: corners everywhere, at every scale."""
    random = np.random.RandomState(seed)
    image = np.zeros((size, size, 3))
    for cells, weight in ((size // 32, 0.3), (size // 12, 0.4), (size // 4, 0.3)):
        coarse = random.rand(cells, cells, 3)
        index = np.arange(size) * cells // size
        image += weight * coarse[index][:, index]
    return image * 255


class Scene:
    """A table that falls away from the camera and a wall behind it; p_world = p of the first camera. The print repeats
    every 1.5 mm x `texture_size`."""

    def __init__(self, texture_size=1024):
        self._planes = [  # normal, offset (n.p = d), two axes on the plane
            (np.array([0.0, -0.8, -0.6]), -0.55, np.array([1.0, 0, 0]), np.array([0, 0.6, -0.8])),
            (np.array([0.0, 0.0, -1.0]), -1.0, np.array([1.0, 0, 0]), np.array([0, 1.0, 0])),
        ]
        self._textures = [_texture(texture_size, 1), _texture(texture_size, 2)]
        u, v = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
        self._rays = np.stack([(u - (WIDTH - 1) / 2) / FOCAL, (v - (HEIGHT - 1) / 2) / FOCAL, np.ones(u.shape)], -1)

    @staticmethod
    def world_from_camera(index):
        """Sideways on an arc, 4 mm and 0.3 degrees a frame."""
        angle = np.deg2rad(-0.3 * index)
        rotation = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        return rotation, np.array([0.004 * index, 0, 0])

    def render(self, index):
        """Colour (bgr, uint8) and depth (m, 0 missing)."""
        rotation, centre = self.world_from_camera(index)
        rays = self._rays @ rotation.T
        depth = np.full(rays.shape[:2], np.inf)
        color = np.zeros(rays.shape)
        for (normal, offset, axis_u, axis_v), texture in zip(self._planes, self._textures):
            with np.errstate(divide="ignore", invalid="ignore"):
                z = (offset - normal @ centre) / (rays @ normal)
            nearer = (z > 0.05) & (z < depth)
            points = centre + rays * np.where(nearer, z, 0)[..., None]
            depth = np.where(nearer, z, depth)
            color = np.where(nearer[..., None], self._look_up(texture, points @ axis_u, points @ axis_v), color)
        return np.clip(color, 0, 255).astype(np.uint8), np.where(np.isfinite(depth), depth, 0)

    @staticmethod
    def _look_up(texture, a_m, b_m):
        """Bilinear, 1.5 mm a texel, repeated."""
        size = texture.shape[0]
        x, y = a_m / 0.0015, b_m / 0.0015
        x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
        fx, fy = (x - x0)[..., None], (y - y0)[..., None]
        at = lambda i, j: texture[(y0 + j) % size, (x0 + i) % size]
        return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy


class StepwiseScene(Scene):
    """Print that looks the same every 48 mm, and a camera that stands still and steps 30 mm aside: what moves least to
    explain the image is a step of 18 mm the other way."""

    STEP_M, FRAMES_PER_STEP = 0.030, 3

    def __init__(self):
        Scene.__init__(self, texture_size=32)

    @classmethod
    def world_from_camera(cls, index):
        return np.eye(3), np.array([cls.STEP_M * (index // cls.FRAMES_PER_STEP), 0, 0])


SCENE = Scene()


def image_message(array, encoding, stamp, frame_id):
    array = np.ascontiguousarray(array)
    message = Image(height=array.shape[0], width=array.shape[1], encoding=encoding, data=array.tobytes())
    message.step = len(message.data) // message.height
    message.header.stamp, message.header.frame_id = stamp, frame_id
    return message


class SyntheticCamera:
    """Publishes frames under `namespace`, and receives the tracker's states for them."""

    def __init__(self, namespace, frame_id="camera_optical", with_info=True, with_masks=False, scene=SCENE,
                 queue_size=10):
        self.frame_id = frame_id
        self.scene = scene
        publisher = lambda topic, kind: rospy.Publisher(namespace + topic, kind, queue_size=queue_size)
        self._color = publisher("/rgb/image_rect_color", Image)
        self._depth = publisher("/depth_registered/image_rect", Image)
        self._info = publisher("/rgb/camera_info", CameraInfo) if with_info else None
        self._mask = publisher("/object_mask", Image) if with_masks else None
        self._changed = threading.Condition()
        self.states = []
        self._subscriber = rospy.Subscriber(namespace + "/camera_tracker/state", TrackingState, self._on_state,
                                            queue_size=100)
        self.stamp = rospy.Time(1000)

    def wait_for_listeners(self, timeout_s=15):
        publishers = [p for p in (self._color, self._depth, self._info, self._mask) if p is not None]
        wait_until(lambda: all(p.get_num_connections() > 0 for p in publishers + [self._subscriber]),
                   "listeners to the images", timeout_s)

    def _on_state(self, state):
        with self._changed:
            self.states.append(state)
            self._changed.notify_all()

    def wait_for_state(self, condition, timeout_s=10):
        """The first state, also of the past, that meets the condition."""
        end = time.monotonic() + timeout_s
        with self._changed:
            while True:
                for state in self.states:
                    if condition(state):
                        return state
                left = end - time.monotonic()
                if left <= 0:
                    raise AssertionError("no such state among %s" % [(s.status, s.reason) for s in self.states[-5:]])
                self._changed.wait(left)

    def send(self, index, color_encoding="bgr8", depth_encoding="32FC1", depth_shift_s=0.0, depth_scale=1,
             covered=False, without_depth=False, depth_frame_id=None, with_mask=True):
        """Publishes the view of place `index` with the next stamp; returns the stamp."""
        self.stamp += rospy.Duration(FRAME_PERIOD_S)
        color, depth = self.scene.render(index)
        if covered:
            color = color // 64
        if covered or without_depth:
            depth = depth * 0
        if depth_encoding == "16UC1":
            depth = np.round(depth * 1000).astype(np.uint16)
        else:
            depth = np.where(depth > 0, depth, np.nan).astype(np.float32)
        if color_encoding == "rgb8":
            color = color[..., ::-1]
        if color_encoding == "mono8":
            color = color.mean(-1).astype(np.uint8)
        depth = depth[::depth_scale, ::depth_scale]
        if self._info:
            self._info.publish(self.camera_info())
        if self._mask and with_mask:
            mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
            self._mask.publish(image_message(mask, "mono8", self.stamp, self.frame_id))
        self._color.publish(image_message(color, color_encoding, self.stamp, self.frame_id))
        self._depth.publish(image_message(depth, depth_encoding, self.stamp + rospy.Duration(depth_shift_s),
                                          depth_frame_id or self.frame_id))
        return self.stamp

    def send_at_once(self, indices):
        """Publishes views without any pause, as fast as they can be written; returns the last stamp."""
        messages = []
        for index in indices:
            self.stamp += rospy.Duration(FRAME_PERIOD_S)
            color, depth = self.scene.render(index)
            messages.append((image_message(color, "bgr8", self.stamp, self.frame_id),
                             image_message(depth.astype(np.float32), "32FC1", self.stamp, self.frame_id)))
        self._info.publish(self.camera_info())
        for color, depth in messages:
            self._color.publish(color)
            self._depth.publish(depth)
        return self.stamp

    def camera_info(self):
        info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob", D=[0.0] * 5)
        info.header.stamp, info.header.frame_id = self.stamp, self.frame_id
        cx, cy = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
        info.K = [FOCAL, 0, cx, 0, FOCAL, cy, 0, 0, 1]
        info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
        info.P = [FOCAL, 0, cx, 0, 0, FOCAL, cy, 0, 0, 0, 1, 0]
        return info

    def track(self, index, **faults):
        """Publishes one frame and returns the tracker's state for it."""
        stamp = self.send(index, **faults)
        return self.wait_for_state(lambda state: state.header.stamp == stamp)

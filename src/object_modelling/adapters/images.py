"""Pixels of sensor_msgs/Image without cv_bridge, and back."""
import numpy as np
from sensor_msgs.msg import Image

from object_modelling.outcome import Code, Failure

DEPTH_UNITS_M = {"16UC1": 0.001, "mono16": 0.001, "32FC1": 1.0}
TYPES = {"16UC1": "u2", "mono16": "u2", "32FC1": "f4", "mono8": "u1", "8UC1": "u1", "8SC1": "i1", "16SC1": "i2",
         "32SC1": "i4"}


def pixels(image, encodings, what):
    """Array of an image with one channel; Failure names the encoding or length that cannot be used."""
    if image.encoding not in encodings:
        raise Failure(Code.BAD_INPUT, "%s has encoding '%s': give one of %s" % (
            what, image.encoding, ", ".join(sorted(encodings))))
    kind = np.dtype(TYPES[image.encoding]).newbyteorder(">" if image.is_bigendian else "<")
    if len(image.data) < image.height * image.step or image.step < image.width * kind.itemsize:
        raise Failure(Code.BAD_INPUT, "%s of %d x %d pixels has only %d bytes, %d a row" % (
            what, image.width, image.height, len(image.data), image.step))
    rows = np.frombuffer(image.data, np.uint8, image.height * image.step).reshape(image.height, image.step)
    return np.ascontiguousarray(rows[:, :image.width * kind.itemsize]).view(kind)


def depth_m(image):
    return pixels(image, DEPTH_UNITS_M, "depth") * DEPTH_UNITS_M[image.encoding]


def mask(image):
    return pixels(image, set(TYPES) - set(DEPTH_UNITS_M), "mask") > 0


def label_message(labels, header):
    """16SC1 of an int16 array."""
    height, width = labels.shape
    return Image(header=header, height=height, width=width, encoding="16SC1", step=2 * width,
                 data=labels.astype("<i2").tobytes())

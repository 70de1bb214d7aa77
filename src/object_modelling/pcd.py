"""PCD files as the object database has them."""
import struct

import numpy as np

from object_modelling.outcome import Code, Failure

LITERAL_END = 32  # control bytes below begin a run of literal bytes
LONG_MATCH = 7


def _decompress_lzf(data, size):
    """LZF: runs of literal bytes, and copies of what lies at most 8 KiB back."""
    out = bytearray(size)
    read, written, end = 0, 0, len(data)
    while read < end:
        control = data[read]
        read += 1
        if control < LITERAL_END:
            length = control + 1
            out[written:written + length] = data[read:read + length]
            read += length
        else:
            length = control >> 5
            if length == LONG_MATCH:
                length += data[read]
                read += 1
            length += 2
            start = written - ((control & 31) << 8) - data[read] - 1
            read += 1
            if start < 0:
                raise ValueError("a copy from before the beginning")
            if start + length <= written:
                out[written:written + length] = out[start:start + length]
            else:  # the copy overlaps what it writes: the same bytes again and again
                pattern = bytes(out[start:written])
                out[written:written + length] = (pattern * (length // len(pattern) + 1))[:length]
        written += length
    if written != size or len(out) != size:
        raise ValueError("%d bytes instead of %d" % (written, size))
    return out


def _header(data):
    """(fields by keyword, where the points begin)"""
    fields, at = {}, 0
    while "DATA" not in fields:
        end = data.index(b"\n", at)
        words = data[at:end].decode("ascii").split()
        if words:
            fields[words[0]] = words[1:]
        at = end + 1
    return fields, at


def read(path):
    """Columns by field name, float32, and (width, height). rgb keeps its bits: view it as uint32. Raises Failure."""
    try:
        with open(path, "rb") as file:
            data = file.read()
        header, at = _header(data)
        names, width, height = header["FIELDS"], int(header["WIDTH"][0]), int(header["HEIGHT"][0])
        if header["DATA"] != ["binary_compressed"] or set(header["SIZE"]) != {"4"} or set(header["COUNT"]) != {"1"}:
            raise ValueError("not compressed floats")
        compressed, size = struct.unpack_from("<II", data, at)
        if size != 4 * len(names) * width * height or len(data) < at + 8 + compressed:
            raise ValueError("it is shorter than its header says")
        columns = np.frombuffer(_decompress_lzf(data[at + 8:at + 8 + compressed], size), "<f4")
        return dict(zip(names, columns.reshape(len(names), -1))), (width, height)
    except FileNotFoundError as error:
        raise Failure(Code.NOT_FOUND, "there is no cloud %s; build the object anew" % path) from error
    except (OSError, ValueError, KeyError, IndexError, struct.error) as error:
        raise Failure(Code.BAD_INPUT, "%s cannot be read: %s; build the object anew" % (path, error)) from error


def colours(rgb):
    """n x 3 red, green, blue of PCL's packed colour."""
    bits = np.ascontiguousarray(rgb).view("<u4")
    return np.stack([bits >> 16 & 255, bits >> 8 & 255, bits & 255], -1).astype(np.uint8)

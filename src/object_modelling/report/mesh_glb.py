"""Binary glTF 2 of a PLY mesh with vertex colours, for viewers; in the frame of the mesh."""
import json
import struct

import numpy as np

from object_modelling.report.object_data import ReportError

MAX_TRIANGLES = 150000
_TYPES = {"float": "f4", "float32": "f4", "double": "f8", "float64": "f8", "uchar": "u1", "uint8": "u1", "char": "i1",
          "int8": "i1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4",
          "uint": "u4", "uint32": "u4"}


def read_ply(path):
    """(vertices n x 3, normals n x 3 or None, colours n x 3 uint8 or None, triangles m x 3) of a binary PLY file."""
    try:
        with open(path, "rb") as file:
            elements = _header(file)
            tables = {name: np.frombuffer(file.read(count * dtype.itemsize), dtype, count)
                      for name, count, dtype in elements}
        vertex, face = tables["vertex"], tables["face"]
        if len(face) and not (face["count"] == 3).all():
            raise ValueError("polygons that are no triangles")
        triangles = face["index"].astype(np.uint32)
        if len(triangles) == 0 or triangles.max() >= len(vertex):
            raise ValueError("no triangles, or vertices that do not exist")
    except (OSError, ValueError, LookupError, UnicodeDecodeError) as error:
        raise ReportError("%s cannot be read: %s" % (path, error)) from error
    names = vertex.dtype.names

    def columns(wanted, dtype):
        return np.stack([vertex[name] for name in wanted], 1).astype(dtype) if set(wanted) <= set(names) else None

    return (columns(("x", "y", "z"), np.float32), columns(("nx", "ny", "nz"), np.float32),
            columns(("red", "green", "blue"), np.uint8), triangles)


def _header(file):
    """[(element, count, dtype)]; leaves the file at the first element."""
    if file.readline().strip() != b"ply" or file.readline().split() != [b"format", b"binary_little_endian", b"1.0"]:
        raise ValueError("not a binary PLY file")
    elements = []
    while True:
        line = file.readline()
        words = line.decode("ascii").split()
        if not line:
            raise ValueError("its header has no end")
        if words[:1] == ["end_header"]:
            return [(name, count, np.dtype(fields)) for name, count, fields in elements]
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][2].extend([("count", "<" + _TYPES[words[2]]), ("index", "<" + _TYPES[words[3]], (3,))])
        elif words[:1] == ["property"]:
            elements[-1][2].append((words[2], "<" + _TYPES[words[1]]))


def decimated(vertices, normals, colours, triangles, max_triangles=MAX_TRIANGLES):
    """Vertices merged on a grid that is coarsened until the triangles are few enough."""
    if len(triangles) <= max_triangles:
        return vertices, normals, colours, triangles
    low = vertices.min(0)
    cell = (vertices.max(0) - low).max() / 1000
    while True:
        keys = np.floor((vertices - low) / cell).astype(np.int64)
        _, merged, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
        merged = merged.reshape(-1)
        corners = merged[triangles]
        kept = corners[(corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) &
                       (corners[:, 2] != corners[:, 0])]
        if len(kept) <= max_triangles:
            break
        cell *= 1.15

    def mean(values):
        sums = np.zeros((len(counts), 3))
        np.add.at(sums, merged, values)
        return sums / counts[:, None]

    new_normals = None
    if normals is not None:
        new_normals = mean(normals)
        new_normals /= np.maximum(np.linalg.norm(new_normals, axis=1, keepdims=True), 1e-9)
    return (mean(vertices).astype(np.float32), None if normals is None else new_normals.astype(np.float32),
            None if colours is None else np.round(mean(colours)).astype(np.uint8), kept.astype(np.uint32))


def glb(vertices, normals, colours, triangles):
    """Bytes of the file."""
    chunks, views, accessors, attributes = [], [], [], {}

    def add(values, component_type, shape, target, **extra):
        data = np.ascontiguousarray(values).tobytes()
        views.append({"buffer": 0, "byteOffset": sum(map(len, chunks)), "byteLength": len(data), "target": target})
        chunks.append(data + b"\0" * (-len(data) % 4))
        accessors.append(dict({"bufferView": len(views) - 1, "componentType": component_type, "count": len(values),
                               "type": shape}, **extra))
        return len(accessors) - 1

    attributes["POSITION"] = add(vertices, 5126, "VEC3", 34962, min=vertices.min(0).tolist(),
                                 max=vertices.max(0).tolist())
    if normals is not None:
        attributes["NORMAL"] = add(normals, 5126, "VEC3", 34962)
    if colours is not None:
        # glTF's vertex colours are linear, pictures are not.
        linear = np.round(65535 * (colours / 255.0) ** 2.2)
        attributes["COLOR_0"] = add(np.column_stack([linear, np.full(len(linear), 65535)]).astype("<u2"), 5123,
                                    "VEC4", 34962, normalized=True)
    indices = add(triangles.reshape(-1).astype("<u4"), 5125, "SCALAR", 34963)
    binary = b"".join(chunks)
    description = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(description, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def glb_of_ply(path):
    return glb(*decimated(*read_ply(path)))

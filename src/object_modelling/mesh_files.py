"""Mesh files: the database's are read (PLY, GLB), those of other programs are made as bytes (PLY, OBJ, GLB, STL)."""
import json
import struct

import cv2
import numpy as np

from object_modelling.meshes import Mesh
from object_modelling.outcome import Code, Failure

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4",
             "double": "<f8", "int8": "i1", "uint8": "u1", "int16": "<i2", "uint16": "<u2", "int32": "<i4",
             "uint32": "<u4", "float32": "<f4", "float64": "<f8"}
GLTF_TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
GLTF_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
GLTF_FLOAT, GLTF_UINT, GLTF_USHORT = 5126, 5125, 5123
# Quaternion of the root node: glTF has y up, the object frame z.
Y_UP_FROM_Z_UP = [-0.5 ** 0.5, 0.0, 0.0, 0.5 ** 0.5]
# glTF's vertex colours are linear, those of pictures and of the database are not.
DISPLAY_GAMMA = 2.2


def _read(path, parse):
    try:
        with open(path, "rb") as file:
            return parse(file.read())
    except FileNotFoundError as error:
        raise Failure(Code.NOT_FOUND, "there is no mesh %s; build the object anew" % path) from error
    except (OSError, ValueError, KeyError, IndexError, struct.error) as error:
        raise Failure(Code.BAD_INPUT, "%s cannot be read: %s; build the object anew" % (path, error)) from error


def read_ply(path):
    return _read(path, _parse_ply)


def _parse_ply(data):
    end = data.index(b"end_header")
    lines = [line.split() for line in data[:end].decode("ascii").splitlines()]
    if ["format", "binary_little_endian", "1.0"] not in lines:
        raise ValueError("no binary PLY")
    counts = {line[1]: int(line[2]) for line in lines if line[:1] == ["element"]}
    faces_at = lines.index(["element", "face", str(counts["face"])])
    fields = [(line[2], PLY_TYPES[line[1]]) for line in lines[:faces_at] if line[:1] == ["property"]]
    at = data.index(b"\n", end) + 1
    points = np.frombuffer(data, fields, counts["vertex"], at)
    corners = np.frombuffer(data, [("count", "u1"), ("indices", "<i4", 3)], counts["face"], at + points.nbytes)
    if lines[faces_at + 1][1:4] not in (["list", "uchar", "int"], ["list", "uint8", "int32"]) or \
            (corners["count"] != 3).any():
        raise ValueError("its faces are no triangles")

    def columns(names):
        return np.stack([points[name] for name in names], 1) if set(names) <= set(points.dtype.names) else None

    triangles = corners["indices"]
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise ValueError("a triangle has a vertex that does not exist")
    return Mesh(columns(["x", "y", "z"]), triangles, columns(["nx", "ny", "nz"]), columns(["red", "green", "blue"]))


def read_glb(path):
    return _read(path, _parse_glb)


def _parse_glb(data):
    magic, _, _, size = struct.unpack_from("<4sIII", data)
    if magic != b"glTF":
        raise ValueError("no GLB")
    description, binary = json.loads(data[20:20 + size].decode()), data[28 + size:]

    def view(index):
        entry = description["bufferViews"][index]
        start = entry.get("byteOffset", 0)
        return binary[start:start + entry["byteLength"]]

    def values(index):
        accessor = description["accessors"][index]
        array = np.frombuffer(view(accessor["bufferView"]), GLTF_TYPES[accessor["componentType"]],
                              accessor["count"] * GLTF_WIDTHS[accessor["type"]], accessor.get("byteOffset", 0))
        return array.reshape(accessor["count"], -1)

    primitive = description["meshes"][0]["primitives"][0]
    attributes = primitive["attributes"]
    uv = values(attributes["TEXCOORD_0"]).astype(float) * [1, -1] + [0, 1]
    texture = cv2.imdecode(np.frombuffer(view(description["images"][0]["bufferView"]), np.uint8), cv2.IMREAD_COLOR)
    if texture is None:
        raise ValueError("its texture is no picture")
    normals = values(attributes["NORMAL"]) if "NORMAL" in attributes else None
    return Mesh(values(attributes["POSITION"]), values(primitive["indices"]), normals, None, uv, texture)


def png(image):
    """Bytes of a PNG."""
    done, data = cv2.imencode(".png", image)
    if not done:
        raise Failure(Code.INTERNAL, "a picture of %s could not be encoded" % (image.shape,))
    return data.tobytes()


def ply(mesh, texture_name=None):
    """Binary PLY; with the name of a picture also texture_u and texture_v of each vertex, as BOP has them."""
    columns = [(mesh.vertices, "<f4", ["x", "y", "z"])]
    if mesh.normals is not None:
        columns.append((mesh.normals, "<f4", ["nx", "ny", "nz"]))
    if mesh.colours is not None:
        columns.append((mesh.colours, "u1", ["red", "green", "blue"]))
    if texture_name is not None:
        columns.append((mesh.uv, "<f4", ["texture_u", "texture_v"]))
    points = np.empty(len(mesh.vertices), [(name, kind) for _, kind, names in columns for name in names])
    for values, _, names in columns:
        for i, name in enumerate(names):
            points[name] = values[:, i]
    while points[:1].tobytes()[:1] in (b"\t", b"\n", b"\r", b" "):  # Assimp would take it for the end of the header
        points["x"][0] = np.nextafter(points["x"][0], np.float32(np.inf))
    faces = np.empty(len(mesh.triangles), [("count", "u1"), ("indices", "<i4", 3)])
    faces["count"], faces["indices"] = 3, mesh.triangles
    kinds = {"<f4": "float", "u1": "uchar"}
    header = ["ply", "format binary_little_endian 1.0"]
    header += ["comment TextureFile " + texture_name] if texture_name is not None else []
    header += ["element vertex %d" % len(points)]
    header += ["property %s %s" % (kinds[kind], name) for _, kind, names in columns for name in names]
    header += ["element face %d" % len(faces), "property list uchar int vertex_indices", "end_header"]
    return "\n".join(header).encode() + b"\n" + points.tobytes() + faces.tobytes()


def obj(mesh, material_library=None):
    """Text of a Wavefront OBJ; without material the colours stand behind the vertices."""
    colours = None if material_library or mesh.colours is None else mesh.colours / 255.0
    lines = ["mtllib " + material_library, "usemtl textured"] if material_library else []
    if colours is None:
        lines += ["v %.7g %.7g %.7g" % tuple(vertex) for vertex in mesh.vertices.tolist()]
    else:
        lines += ["v %.7g %.7g %.7g %.4g %.4g %.4g" % tuple(row)
                  for row in np.column_stack([mesh.vertices, colours]).tolist()]
    corner = "%d"
    if material_library:
        lines += ["vt %.6f %.6f" % tuple(uv) for uv in mesh.uv.tolist()]
        corner += "/%d"
    if mesh.normals is not None:
        lines += ["vn %.5g %.5g %.5g" % tuple(normal) for normal in mesh.normals.tolist()]
        corner += "/%d" if material_library else "//%d"
    repeats = corner.count("%d")
    face = "f " + " ".join([corner] * 3)
    lines += [face % tuple(row) for row in np.repeat(mesh.triangles + 1, repeats, axis=1).tolist()]
    return "\n".join(lines).encode() + b"\n"


def mtl(texture_name):
    """Text of the material of obj()."""
    return ("newmtl textured\nKa 1 1 1\nKd 1 1 1\nillum 1\nmap_Kd %s\n" % texture_name).encode()


def stl(mesh):
    """Binary STL."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    records = np.zeros(len(a), [("values", "<f4", 12), ("attribute", "<u2")])
    records["values"] = np.column_stack(
        [normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300), a, b, c])
    return b"binary STL".ljust(80, b" ") + struct.pack("<I", len(records)) + records.tobytes()


class _GlbBuffer:
    """Collects what goes into the binary chunk of a GLB."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, data, **more):
        self.views.append(dict({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}, **more))
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def add_values(self, values, component_type, shape, target, **more):
        data = np.ascontiguousarray(values, GLTF_TYPES[component_type])
        self.accessors.append(dict({"bufferView": self.add(data.tobytes(), target=target), "type": shape,
                                    "componentType": component_type, "count": len(data)}, **more))
        return len(self.accessors) - 1


def glb(mesh):
    """Binary glTF 2 in metres; vertices in the object frame, below a node that turns its z up into glTF's y up."""
    of_vertices, of_indices = 34962, 34963
    buffer = _GlbBuffer()
    vertices = mesh.vertices.astype("<f4")
    attributes = {"POSITION": buffer.add_values(vertices, GLTF_FLOAT, "VEC3", of_vertices, min=vertices.min(0).tolist(),
                                                max=vertices.max(0).tolist())}
    if mesh.normals is not None:
        attributes["NORMAL"] = buffer.add_values(mesh.normals, GLTF_FLOAT, "VEC3", of_vertices)
    material = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    description = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                   "nodes": [{"mesh": 0, "rotation": Y_UP_FROM_Z_UP}]}
    if mesh.texture is not None:
        attributes["TEXCOORD_0"] = buffer.add_values(mesh.uv * [1, -1] + [0, 1], GLTF_FLOAT, "VEC2", of_vertices)
        material["baseColorTexture"] = {"index": 0}
        description.update(images=[{"bufferView": buffer.add(png(mesh.texture)), "mimeType": "image/png"}],
                           samplers=[{}], textures=[{"source": 0, "sampler": 0}])
    elif mesh.colours is not None:
        linear = np.round(65535 * (mesh.colours / 255.0) ** DISPLAY_GAMMA)
        attributes["COLOR_0"] = buffer.add_values(np.column_stack([linear, np.full(len(linear), 65535)]), GLTF_USHORT,
                                                  "VEC4", of_vertices, normalized=True)
    indices = buffer.add_values(mesh.triangles.reshape(-1), GLTF_UINT, "SCALAR", of_indices)
    description.update(meshes=[{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
                       materials=[{"pbrMetallicRoughness": material}], accessors=buffer.accessors,
                       bufferViews=buffer.views, buffers=[{"byteLength": len(buffer.data)}])
    text = json.dumps(description, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(buffer.data)) +
            struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(buffer.data), b"BIN\0") + buffer.data)

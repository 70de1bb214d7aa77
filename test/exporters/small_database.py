"""A database of exact boxes, as far as exporters read it: every number of it is known."""
import hashlib
import os
import struct

import cv2
import numpy as np
import yaml

from object_modelling import mesh_files, meshes

SIZE_M = np.array([0.08, 0.06, 0.12])
CAMERA = np.array([[260.0, 0, 79.5], [0, 250.0, 59.5], [0, 0, 1]])
SIZE_PX = (160, 120)
VIEWS = 3  # of each session
TABLE_M = 1.5  # depth beside the object
DENSITY_KG_M3 = 400.0
SYMMETRIES = [
    {"of": of, "kind": "discrete", "axis": axis, "point_m": [0.0, 0.0, 0.0], "order": 2, "error_mm": 0.1}
    for of, axis in (("texture", [0.0, 0.0, 1.0]), ("texture", [1.0, 0.0, 0.0]), ("shape", [0.0, 1.0, 0.0]))]


def textured_box():
    """24 vertices, each side with its own part of a texture of 2 x 3 squares."""
    vertices, uv, normals, triangles = [], [], [], []
    for side in range(6):
        axis, sign = side // 2, 1 - 2 * (side % 2)
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
            corner = np.zeros(3)
            corner[axis], corner[u], corner[v] = sign, 2 * i - 1, 2 * j - 1
            vertices.append(corner * SIZE_M / 2)
            normals.append(sign * np.eye(3)[axis])
            uv.append([(side % 3 + 0.1 + 0.8 * i) / 3, (side // 3 + 0.1 + 0.8 * j) / 2])
        first = 4 * side
        quad = [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        triangles += quad if sign > 0 else [t[::-1] for t in quad]
    return meshes.Mesh(vertices, triangles, np.array(normals), None, np.array(uv), texture())


def texture():
    """BGR; side s has the colour (40 s, 255 - 40 s, 100)."""
    image = np.zeros((64, 96, 3), np.uint8)
    for side in range(6):
        rows = slice(32, 64) if side < 3 else slice(0, 32)  # v is upwards
        image[rows, 32 * (side % 3):32 * (side % 3 + 1)] = (40 * side, 255 - 40 * side, 100)
    return image


def plain_box(steps=8):
    """Closed, with vertex colours, `steps` squares along each edge."""
    numbers, vertices, triangles = {}, [], []

    def number(place):
        if place not in numbers:
            numbers[place] = len(vertices)
            vertices.append((np.array(place) / steps - 0.5) * SIZE_M)
        return numbers[place]

    for axis in range(3):
        for sign in (0, 1):
            for i in range(steps):
                for j in range(steps):
                    corners = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        place = [0, 0, 0]
                        place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = sign * steps, i + a, j + b
                        corners.append(number(tuple(place)))
                    quad = [corners[:3], [corners[0], corners[2], corners[3]]]
                    triangles += quad if sign else [t[::-1] for t in quad]
    vertices = np.array(vertices)
    mesh = meshes.Mesh(vertices, triangles, colours=np.round(255 * (vertices / SIZE_M + 0.5)).astype(np.uint8))
    mesh.normals = meshes.vertex_normals(mesh)
    return mesh


def model_from_camera(number):
    """Looks at the origin from 0.6 m, the first session from above, the second from below."""
    angle, height = 0.7 * number, 0.35 if number < VIEWS else -0.35
    eye = np.array([0.5 * np.cos(angle), 0.5 * np.sin(angle), height])
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], 1)
    pose[:3, 3] = eye
    return pose


def depth_of_box(pose):
    """Exact depth in metres of each pixel's ray; 0 where it misses."""
    columns, rows = np.meshgrid(np.arange(SIZE_PX[0]), np.arange(SIZE_PX[1]))
    rays = np.stack([(columns - CAMERA[0, 2]) / CAMERA[0, 0], (rows - CAMERA[1, 2]) / CAMERA[1, 1],
                     np.ones(columns.shape)], -1) @ pose[:3, :3].T
    near, far = (np.sort(np.stack([(s * SIZE_M / 2 - pose[:3, 3]) / rays for s in (-1, 1)]), 0)[k] for k in (0, 1))
    near, far = near.max(-1), far.min(-1)
    return np.where(near < far, near, 0)


def compressed(data):
    """LZF of literals alone."""
    return b"".join(bytes([len(data[i:i + 32]) - 1]) + data[i:i + 32] for i in range(0, len(data), 32))


def write_pcd(path, columns, size):
    names = list(columns)
    data = b"".join(np.asarray(columns[name]).astype("<f4" if name != "rgb" else "<u4").tobytes() for name in names)
    count = len(names)
    header = ("VERSION 0.7\nFIELDS %s\nSIZE%s\nTYPE%s\nCOUNT%s\nWIDTH %d\nHEIGHT %d\nVIEWPOINT 0 0 0 1 0 0 0\n"
              "POINTS %d\n") % (
        " ".join(names), " 4" * count, " F" * count, " 1" * count, size[0], size[1], size[0] * size[1])
    packed = compressed(data)
    with open(path, "wb") as file:
        file.write(header.encode() + b"DATA binary_compressed\n" + struct.pack("<II", len(packed), len(data)) + packed)


def write_view(folder, number):
    """Colour (10 number, column, row); the object's depth, a plane beside it, nothing in the first row."""
    pose = model_from_camera(number)
    depth = depth_of_box(pose)
    mask = depth > 0
    depth[~mask] = TABLE_M
    depth[0] = np.nan
    columns, rows = np.meshgrid(np.arange(SIZE_PX[0]), np.arange(SIZE_PX[1]))
    rgb = (10 * number << 16 | columns << 8 | rows).astype(np.uint32)
    x, y = (columns - CAMERA[0, 2]) / CAMERA[0, 0] * depth, (rows - CAMERA[1, 2]) / CAMERA[1, 1] * depth
    write_pcd(os.path.join(folder, "cloud_%08d.pcd" % number),
              {"x": x.ravel(), "y": y.ravel(), "z": depth.ravel(), "rgb": rgb.ravel()}, SIZE_PX)
    np.savetxt(os.path.join(folder, "pose_%08d.txt" % number), pose, fmt="%.17g")
    np.savetxt(os.path.join(folder, "object_indices_%08d.txt" % number), np.nonzero(mask.ravel())[0], fmt="%d")
    picture = np.stack([rows, columns, np.full(rows.shape, 10 * number)], -1).astype(np.uint8)
    cv2.imwrite(os.path.join(folder, "image_%08d.jpg" % number), picture)


def write_object(root, object_id, textured=True, version_2=False, sessions=("first", "second")):
    """`version_2`: with everything that objects may have from then on."""
    folder = os.path.join(root, object_id)
    for name in ("mesh", "views"):
        os.makedirs(os.path.join(folder, name))
    mesh = plain_box()
    contents = {"mesh.ply": mesh_files.ply(mesh)}
    if textured:
        contents["textured.glb"] = mesh_files.glb(textured_box())
    if version_2:
        half = meshes.box(SIZE_M * [0.5, 1, 1], np.eye(4))
        for i, sign in enumerate((-1, 1)):
            part = meshes.Mesh(half.vertices + [sign * SIZE_M[0] / 4, 0, 0], half.triangles)
            contents["collision_%02d.ply" % i] = mesh_files.ply(part)
    for name, content in contents.items():
        with open(os.path.join(folder, "mesh", name), "wb") as file:
            file.write(content)
    write_pcd(os.path.join(folder, "cloud.pcd"), dict(zip("xyz", mesh.vertices.T)), (len(mesh.vertices), 1))
    count = VIEWS * len(sessions)
    for number in range(count):
        write_view(os.path.join(folder, "views"), number)
    standing = np.eye(4)
    standing[2, 3] = SIZE_M[2] / 2
    description = {
        "schema_version": 2 if version_2 else 1, "id": object_id, "name": "A <box> & more", "unit": "metre",
        "handedness": "right", "size_m": SIZE_M.tolist(), "diameter_m": float(np.linalg.norm(SIZE_M)),
        "model_from_box": np.eye(4).tolist(), "support_from_model": [standing.tolist()],
        "sessions": [{"id": session, "keyframe_count": VIEWS, "model_from_session": np.eye(4).tolist()}
                     for session in sessions],
        "views": [{"index": i, "stamp_s": float(i), "width_px": SIZE_PX[0], "height_px": SIZE_PX[1],
                   "fx_px": CAMERA[0, 0].item(), "fy_px": CAMERA[1, 1].item(), "cx_px": CAMERA[0, 2].item(),
                   "cy_px": CAMERA[1, 2].item(), "session": sessions[i // VIEWS]} for i in range(count)]}
    if version_2:
        volume, _, inertia = meshes.moments(mesh)
        description.update(symmetries=SYMMETRIES, collision_parts=2, mass_properties={
            "closed": True, "of": "mesh", "volume_m3": float(volume), "center_of_mass_m": [0.001, 0.002, 0.003],
            "inertia_per_density_m5": inertia.ravel().tolist(), "density_kg_m3": DENSITY_KG_M3,
            "mass_kg": float(DENSITY_KG_M3 * volume)})
    write_description(root, object_id, description)
    return description


def write_description(root, object_id, description):
    """object.yaml, and the manifest of all objects that are there."""
    with open(os.path.join(root, object_id, "object.yaml"), "w") as text:
        yaml.safe_dump(description, text)
    write_manifest(root)


def write_manifest(root):
    entries = []
    for name in sorted(os.listdir(root)):
        path = os.path.join(root, name, "object.yaml")
        if os.path.isfile(path):
            with open(path, "rb") as file:
                entries.append({"id": name, "content_hash": hashlib.sha256(file.read()).hexdigest(), "partial": False})
    with open(os.path.join(root, "manifest.yaml"), "w") as text:
        yaml.safe_dump({"schema_version": 1, "unit": "metre", "handedness": "right", "objects": entries}, text)

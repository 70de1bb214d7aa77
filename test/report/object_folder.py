"""Folders of objects as the database has them, as far as the report reads them."""
import json
import os
import struct

import cv2
import numpy as np
import yaml

HOSTILE_NAME = "<script>alert(1)</script>\" onload=\"alert(2)\" {{ 7 * 6 }} & $x_1$"


def box_mesh(steps=6):
    """Vertices, normals, colours, triangles of a coloured box of 80 x 60 x 120 mm."""
    vertices, normals, colours, triangles = [], [], [], []
    half = np.array([0.04, 0.03, 0.06])
    for axis in range(3):
        for sign in (-1, 1):
            first, (u, v) = len(vertices), [(axis + 1) % 3, (axis + 2) % 3]
            for i in range(steps + 1):
                for j in range(steps + 1):
                    place = np.zeros(3)
                    place[axis], place[u], place[v] = sign, 2 * i / steps - 1, 2 * j / steps - 1
                    vertices.append(place * half)
                    normals.append(sign * np.eye(3)[axis])
                    colours.append(60 + 195 * (np.eye(3)[axis] * (0.5 + 0.5 * sign)))
            for i in range(steps):
                for j in range(steps):
                    a, b = first + i * (steps + 1) + j, first + (i + 1) * (steps + 1) + j
                    quad = [(a, b, b + 1), (a, b + 1, a + 1)]
                    triangles += quad if sign > 0 else [t[::-1] for t in quad]
    return (np.array(vertices, np.float32), np.array(normals, np.float32), np.array(colours, np.uint8),
            np.array(triangles, np.uint32))


def glb(vertices, normals, colours, triangles):
    """Bytes of a binary glTF 2 with vertex colours."""
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


def residual(keyframe_id, after_px=0.2, after_m=0.001, count=100):
    return {"keyframe_id": keyframe_id, "observation_count": count, "reprojection_rmse_before_px": 0.6,
            "reprojection_rmse_after_px": after_px, "depth_rmse_before_m": 0.002, "depth_rmse_after_m": after_m}


def quality():
    """Twelve keyframes round the object: a red, an amber, one left out; and a session that was not refined."""
    residuals = [residual(k) for k in range(12)]
    residuals[3] = residual(3, after_px=0.8)
    residuals[7] = residual(7, after_m=0.02)
    views = [{"index": k, "session_id": "up", "keyframe_id": k,
              "camera_position_m": [float(0.6 * np.cos(k / 2)), float(0.6 * np.sin(k / 2)), 0.3]} for k in range(12)]
    views.append({"index": 12, "session_id": "down", "keyframe_id": 0, "camera_position_m": [0.5, 0.0, 0.4]})
    counts = [[0] * 24 for _ in range(7)] + [[3] * 24 for _ in range(5)]
    return {"schema_version": 1,
            "figures": {"view_count": 13, "size_m": [0.08, 0.06, 0.12], "diameter_m": 0.156, "point_count": 1000,
                        "vertex_count": 294, "triangle_count": 432, "inconsistent_observation_ratio": 0.01},
            "sigma": {"mean_m": 2e-4, "median_m": 1.9e-4, "p95_m": 4e-4, "histogram_bin_width_m": 1e-5,
                      "histogram_counts": list(range(40))},
            "coverage": {"direction_ratio": 0.4, "upper_direction_ratio": 0.8, "mesh_seen_ratio": 0.97,
                         "mesh_seen_by_3_ratio": 0.91, "view_cone_rad": 0.52, "view_counts": counts},
            "sessions": [{"id": "up", "keyframe_count": 12, "tracked_against": "scene", "refinement": {
                              "iterations": 9, "initial_cost": 10.0, "final_cost": 2.0, "color_offset_px": [0.2, 0.4],
                              "link_count": 3, "rejected_link_count": 1, "left_out": [11], "keyframes": residuals}},
                         {"id": "down", "keyframe_count": 1, "tracked_against": "object", "refinement": None}],
            "views": views, "stage_s": {"load": 0.4, "fuse": 1.2, "surface": 0.7, "describe": 0.1},
            "parameters": {"fusion/resolution_m": 0.002, "surface/resolution_m": 0.002},
            "versions": {"object_modelling": "0.1.0", "opencv": "4.6.0", "pcl": "1.13.0", "ceres": "2.1.0",
                         "eigen": "3.4.0"}}


def make(folder, name="A box", figures=None, **more):
    """`more` are further keys of object.yaml."""
    os.makedirs(os.path.join(folder, "mesh"))
    with open(os.path.join(folder, "mesh", "textured.glb"), "wb") as file:
        file.write(glb(*box_mesh()))
    cv2.imwrite(os.path.join(folder, "turntable.png"), np.full((40, 320, 3), 200, np.uint8))
    for file, content in (("object.yaml", dict(more, id="box", name=name)), ("quality.yaml", figures or quality())):
        with open(os.path.join(folder, file), "w") as text:
            yaml.safe_dump(content, text)
    return folder

"""Measures the model of a carton. Its large faces bulge, so its thickness is taken next to the folded edges."""

import numpy as np

PLY_TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1",
             "int": "<i4", "int32": "<i4"}


def read_ply_vertices_m(path):
    """Vertex positions (n, 3) of a binary little-endian PLY file whose first element is the vertices."""
    with open(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            line = file.readline()
            if not line:
                raise ValueError(f"{path}: no PLY header")
            header.append(line.decode("ascii").strip())
        if "format binary_little_endian 1.0" not in header:
            raise ValueError(f"{path}: not a binary little-endian PLY file")
        start = next(i for i, line in enumerate(header) if line.startswith("element vertex"))
        fields = []
        for line in header[start + 1:]:
            if not line.startswith("property"):
                break
            _, kind, name = line.split()
            fields.append((name, PLY_TYPES[kind]))
        vertices = np.fromfile(file, np.dtype(fields), int(header[start].split()[2]))
    return np.stack([vertices["x"], vertices["y"], vertices["z"]], axis=1).astype(float)


def fold_thickness_m(mesh_path):
    """Distance of the two large faces (normal along y of the object frame) beside the upright folds: where x is 40 to 44 %
    of the length from the middle, over the middle 80 % of the height; mean of both folds."""
    points = read_ply_vertices_m(mesh_path)
    length, height = np.ptp(points[:, 0]), np.ptp(points[:, 2])
    x = (points[:, 0] - (points[:, 0].max() + points[:, 0].min()) / 2) / length
    upright = np.abs(points[:, 2] - (points[:, 2].max() + points[:, 2].min()) / 2) < 0.4 * height
    folds = []
    for side in (-1, 1):
        y = points[upright & (side * x > 0.40) & (side * x < 0.44), 1]
        folds.append(np.median(y[y > 0]) - np.median(y[y < 0]))
    return float(np.mean(folds))

"""Which pixel shows which of the detected objects."""
import cv2
import numpy as np

NOTHING = -1
MAX_DEPTH_BEHIND_M = 0.02  # of a surface behind what was measured: more is hidden
SUBPIXEL_BITS = 4


class Surface:
    """Mesh of an object_modelling/ObjectModel, m, object frame."""

    def __init__(self, mesh):
        self.vertices = np.array([(p.x, p.y, p.z) for p in mesh.vertices]).reshape(-1, 3)
        self.triangles = np.array(mesh.triangles, int).reshape(-1, 3)


def draw_depth(surface, camera_from_model, camera_matrix, shape):
    """Depth of the mesh in m per pixel, infinite beside it. Triangles have one depth each: for masks."""
    depth = np.full(shape, np.inf, np.float32)
    points = surface.vertices @ camera_from_model[:3, :3].T + camera_from_model[:3, 3]
    triangles = surface.triangles[(points[surface.triangles][:, :, 2] > 0.01).all(1)]
    if not len(triangles):
        return depth
    pixels = points @ camera_matrix.T
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = pixels[:, :2] / pixels[:, 2:]
    mean_depth = points[triangles][:, :, 2].mean(1)
    far_first = np.argsort(-mean_depth, kind="stable")
    corners = np.round(pixels[triangles[far_first]] * 2 ** SUBPIXEL_BITS).clip(-2 ** 24, 2 ** 24).astype(np.int32)
    for triangle, z in zip(corners, mean_depth[far_first]):
        cv2.fillConvexPoly(depth, triangle, float(z), shift=SUBPIXEL_BITS)
    return depth


def label_image(surfaces, poses, camera_matrix, depth_m):
    """int16: the index of the nearest of the objects that is seen in a pixel, or NOTHING. `depth_m`: measured, 0 or NaN
    where missing."""
    measured = np.where(depth_m > 0, depth_m, np.inf)
    nearest = np.full(depth_m.shape, np.inf, np.float32)
    labels = np.full(depth_m.shape, NOTHING, np.int16)
    for index, (surface, pose) in enumerate(zip(surfaces, poses)):
        depth = draw_depth(surface, pose, camera_matrix, depth_m.shape)
        shown = (depth < nearest) & (depth - measured < MAX_DEPTH_BEHIND_M) & np.isfinite(depth)
        labels[shown] = index
        nearest[shown] = depth[shown]
    return labels


def box_of(mask):
    """x, y, width, height of what is set; zeros where nothing is."""
    rows, columns = np.nonzero(mask)
    if not len(rows):
        return 0, 0, 0, 0
    return columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1

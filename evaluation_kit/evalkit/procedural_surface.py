"""Surfaces of procedural objects: turned, extruded, swept and box-like parts, their normals and texture coordinates.

A part is a closed surface made of patches. Lengths in metres, z up; seen from outside, a patch's u runs to the right
and its v upwards, so that what is printed on it can be read. Texture coordinates are metres on the patch's region, a
rectangle of the texture of its own.
"""

import numpy as np
from numba import njit
from scipy.spatial import Delaunay

SEGMENTS = 64   # round a turned part


class Patch:
    """Triangles of one texture region.

    points (n, 3), normals (n, 3) and uv (n, 2) in metres per vertex; faces (m, 3); region: name, whose part before
    the slash is the part it belongs to; size (2,): width and height of the region in metres.
    """

    def __init__(self, points, normals, uv, faces, region):
        self.points, self.normals = np.asarray(points, float), np.asarray(normals, float)
        self.uv = np.asarray(uv, float) - np.min(uv, axis=0)
        self.faces, self.region = np.asarray(faces, int), region
        self.size = self.uv.max(0)

    def transformed(self, rotation, translation=(0, 0, 0)):
        """The patch turned and then moved."""
        rotation = np.asarray(rotation, float)
        points, normals = self.points @ rotation.T + translation, self.normals @ rotation.T
        return Patch(points, normals, self.uv, self.faces, self.region)


def transformed(part, rotation=np.eye(3), translation=(0, 0, 0)):
    """A part (list of patches) turned and then moved."""
    return [p.transformed(rotation, translation) for p in part]


def _grid_faces(rows, columns):
    i, j = np.mgrid[0:rows - 1, 0:columns - 1]
    a = (i * columns + j).ravel()
    return np.concatenate([np.stack([a, a + 1, a + columns + 1], 1), np.stack([a, a + columns + 1, a + columns], 1)])


def _unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1), 1e-20)[..., None]


def _grid_normals(points, closed):
    """Unit normals (r, c, 3) of a grid of points; `closed`: the last column repeats the first."""
    du = np.gradient(points, axis=1)
    if closed:
        du[:, 0] = du[:, -1] = points[:, 1] - points[:, -2]
    dv = np.gradient(points, axis=0) if len(points) > 2 else np.repeat(points[1:] - points[:1], 2, axis=0)
    for row in (0, -1):   # at a pole the columns' directions vanish: take those of the row beside it
        if np.ptp(points[row], axis=0).max() < 1e-9:
            du[row] = du[1 if row == 0 else -2]
    return _unit(np.cross(du, dv))


def _grid_patch(points, uv, normals, region):
    rows, columns = points.shape[:2]
    return Patch(points.reshape(-1, 3), normals.reshape(-1, 3), uv.reshape(-1, 2), _grid_faces(rows, columns), region)


def cross_section(aspect=1.0, exponent=2.0, segments=SEGMENTS):
    """Closed superellipse |x|^e + |y / aspect|^e = 1 with its points at equal distances: (segments + 1, 2)."""
    angle = np.linspace(0, 2 * np.pi, 4001)
    c, s = np.cos(angle), np.sin(angle)
    curve = np.stack([np.sign(c) * np.abs(c) ** (2 / exponent), aspect * np.sign(s) * np.abs(s) ** (2 / exponent)], 1)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    at = np.linspace(0, length[-1], segments + 1)
    ring = np.stack([np.interp(at, length, curve[:, k]) for k in range(2)], 1)
    ring[-1] = ring[0]
    return ring


def lathe(sections, body=None, neck=None):
    """A turned part from its profile, which runs up the outside (and down the inside of a hollow one).

    sections: list of (region, [(r, z), ...], sharp): consecutive stretches of the profile; `sharp`: an edge lies before
    the stretch. body, neck: cross_section()s; with `neck` a profile point may be (r, z, share of the neck's section).
    """
    body = cross_section() if body is None else body
    neck = body if neck is None else neck
    patches, group = [], []
    for k, section in enumerate(sections):
        group.append(section)
        if k + 1 == len(sections) or sections[k + 1][2]:
            patches += _lathe_group(group, body, neck)
            group = []
    return patches


def _lathe_group(group, body, neck):
    """Patches of stretches without a sharp edge between them."""
    rows, spans = [], []
    for region, profile, _ in group:
        profile = [(*p, 0.0)[:3] for p in profile]
        first = len(rows) - 1 if rows else 0
        rows += profile[1:] if rows else profile
        spans.append((region, first, len(rows)))
    r, z, share = np.array(rows, float).T
    ring = (1 - share)[:, None, None] * body + share[:, None, None] * neck
    points = np.concatenate([r[:, None, None] * ring, np.broadcast_to(z[:, None, None], (*ring.shape[:2], 1))], axis=2)
    normals = _grid_normals(points, closed=True)
    patches = []
    for region, first, last in spans:
        p = points[first:last]
        if r[first] < 1e-9 or r[last - 1] < 1e-9:   # a lid: printed from above or below
            upwards = np.sign(normals[first:last, :, 2].sum())
            uv = np.stack([upwards * p[:, :, 0], p[:, :, 1]], axis=2)
        else:
            round_it = np.linalg.norm(np.diff(p, axis=1), axis=2).sum(1).max()
            along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=2).max(1))])
            uv = np.stack(np.broadcast_arrays(np.linspace(0, round_it, p.shape[1])[None], along[:, None]), axis=2)
        patches.append(_grid_patch(p, uv, normals[first:last], region))
    return patches


BOX_SIDES = {"front": ((1, 0, 0), (0, 0, 1)), "back": ((-1, 0, 0), (0, 0, 1)), "right": ((0, 1, 0), (0, 0, 1)),
             "left": ((0, -1, 0), (0, 0, 1)), "top": ((1, 0, 0), (0, 1, 0)), "bottom": ((1, 0, 0), (0, -1, 0))}


def box(size, radius=0.0, name="box", cells=10):
    """A box (x, y, z extents) whose edges are rounded with `radius`, standing on z = 0; front towards -y."""
    half = np.asarray(size, float) / 2
    patches = []
    for side, (right, up) in BOX_SIDES.items():
        right, up = np.array(right, float), np.array(up, float)
        out = np.cross(right, up)
        h = [float(np.abs(v) @ half) for v in (right, up, out)]
        s, t = (_box_ticks(h[k], radius, cells) for k in range(2))
        flat = s[None, :, None] * right + t[:, None, None] * up + h[2] * out
        inner = np.clip(flat, -(half - radius), half - radius)
        normals = _unit(flat - inner) if radius > 0 else np.broadcast_to(out, flat.shape)
        points = inner + radius * normals + [0, 0, half[2]]
        uv = np.stack(np.broadcast_arrays(s[None], t[:, None]), axis=2)
        patches.append(_grid_patch(points, uv, normals, f"{name}/{side}"))
    return patches


def _box_ticks(half, radius, cells):
    """Grid lines across a box's side; within the rounding at equal angles."""
    flat = np.linspace(-(half - radius), half - radius, cells + 1)
    if radius <= 0:
        return flat
    bend = half - radius + radius * np.tan(np.linspace(0, np.pi / 4, 6)[1:])
    return np.concatenate([-bend[::-1], flat, bend])


def rounded_outline(corners, radii, spacing):
    """A closed polyline, counterclockwise, through polygon corners that are rounded with radii: (n, 2)."""
    corners = np.asarray(corners, float)
    if np.cross(corners, np.roll(corners, -1, axis=0)).sum() < 0:
        corners, radii = corners[::-1], np.broadcast_to(radii, len(corners))[::-1]
    radii = np.broadcast_to(radii, len(corners))
    curve = []
    for k, corner in enumerate(corners):
        a, b = corners[k - 1] - corner, corners[(k + 1) % len(corners)] - corner
        la, lb = np.linalg.norm(a), np.linalg.norm(b)
        half = np.arccos(np.clip(a @ b / (la * lb), -1, 1)) / 2
        cut = min(radii[k] / np.tan(half), 0.49 * la, 0.49 * lb)
        start, end = corner + a / la * cut, corner + b / lb * cut
        count = max(2, int(np.ceil((np.pi - 2 * half) / np.radians(20))) + 1)
        t = np.linspace(0, 1, count)[:, None]
        weight = np.sin(half)   # of the rational Bezier curve that is a circle's arc
        curve.append(((1 - t) ** 2 * start + 2 * t * (1 - t) * weight * corner + t ** 2 * end)
                     / ((1 - t) ** 2 + 2 * t * (1 - t) * weight + t ** 2))
    curve = np.concatenate(curve)
    following = np.roll(curve, -1, axis=0)
    pieces = []
    for p, q in zip(curve, following):
        count = max(1, int(np.ceil(np.linalg.norm(q - p) / spacing)))
        pieces.append(p + np.arange(count)[:, None] / count * (q - p))
    outline = np.concatenate(pieces)
    return outline[np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1) > spacing * 1e-3]


def _inset(outline, distance):
    """The outline moved inwards by `distance` along its corners' bisectors."""
    edge = _unit(np.roll(outline, -1, axis=0) - outline)
    normal = np.stack([-edge[:, 1], edge[:, 0]], 1)
    bisector = normal + np.roll(normal, 1, axis=0)
    return outline + distance * bisector / np.maximum((bisector ** 2).sum(1) / 2, 0.5)[:, None]


def extrude(outline, thickness, bevel, name, spacing):
    """A plate with an outline in x, y, from z = 0 to `thickness`, its edges bevelled at 45 degrees.

    The bevel is as wide as asked for or as the outline's tightest bend allows.
    """
    inner = _inset(outline, bevel)
    while ((np.roll(inner, -1, axis=0) - inner) * (np.roll(outline, -1, axis=0) - outline)).sum(1).min() <= 0:
        bevel *= 0.8
        inner = _inset(outline, bevel)
    levels = [(inner, 0.0), (outline, bevel), (outline, thickness - bevel), (inner, thickness)]
    patches = []
    for k, part in enumerate(("lower_bevel", "side", "upper_bevel")):
        rows = 2 if k != 1 else max(2, int(np.ceil((thickness - 2 * bevel) / (2 * spacing))) + 1)
        (a, za), (b, zb) = levels[k], levels[k + 1]
        t = np.linspace(0, 1, rows)[:, None, None]
        height = np.broadcast_to((1 - t) * za + t * zb, (rows, len(a), 1))
        points = np.concatenate([(1 - t) * a + t * b, height], axis=2)
        points = np.concatenate([points, points[:, :1]], axis=1)
        around = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points[-1 if k == 0 else 0], axis=0), axis=1))])
        up = np.linspace(0, np.linalg.norm(points[-1, 0] - points[0, 0]), rows)
        uv = np.stack(np.broadcast_arrays(around[None], up[:, None]), axis=2)
        patches.append(_grid_patch(points, uv, _grid_normals(points, closed=True), f"{name}/{part}"))
    triangles, flat = _fill(inner, spacing)
    for z, sign, part in ((0.0, -1.0, "under"), (thickness, 1.0, "upper")):
        points = np.column_stack([flat, np.full(len(flat), z)])
        faces = triangles if sign > 0 else triangles[:, ::-1]
        patches.append(Patch(points, np.tile([0, 0, sign], (len(flat), 1)), flat * [sign, 1], faces, f"{name}/{part}"))
    return patches


def _fill(outline, spacing):
    """Triangulates the inside of a densely sampled outline: (faces, points), the outline's points first."""
    low, high = outline.min(0), outline.max(0)
    step = 2.5 * spacing
    x, y = np.meshgrid(np.arange(low[0] + step / 3, high[0], step), np.arange(low[1] + step / 3, high[1], step))
    inside = np.stack([x.ravel(), y.ravel()], 1)
    distance = np.sqrt(((inside[:, None] - outline[None]) ** 2).sum(2).min(1)) if len(inside) else np.zeros(0)
    inside = inside[distance > 0.9 * spacing]
    points = np.concatenate([outline, inside[_in_polygon(inside, outline)]])
    faces = Delaunay(points).simplices
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = np.cross(b - a, c - a)
    faces[area < 0] = faces[area < 0][:, ::-1]
    keep = (np.abs(area) > 1e-12) & _in_polygon((a + b + c) / 3, outline)
    return faces[keep], points


def _in_polygon(points, polygon):
    """Which points (n, 2) lie in a closed polygon."""
    x, y = points[:, 0:1], points[:, 1:2]
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    crosses = (y0 > y) != (y1 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = x0 + (y - y0) / (y1 - y0) * (x1 - x0)
    return (crosses & (x < at)).sum(1) % 2 == 1


def tube(path, width, height, name, across=(0, 1, 0), exponent=2.5):
    """A rod along a path (n, 3) in a plane whose normal is `across`; width along it, height in the plane."""
    path, across = np.asarray(path, float), np.asarray(across, float)
    ring = cross_section(1.0, exponent, 20) / 2
    forward = _unit(np.gradient(path, axis=0))
    side = np.cross(across, forward)
    points = path[:, None] + ring[None, :, 0:1] * height * side[:, None] + ring[None, :, 1:2] * width * across
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    around = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points[0], axis=0), axis=1))])
    uv = np.stack(np.broadcast_arrays(around[None], along[:, None]), axis=2)
    patches = [_grid_patch(points, uv, _grid_normals(points, closed=True), f"{name}/rod")]
    for end, normal in ((0, -forward[0]), (-1, forward[-1])):
        disc = np.stack([np.repeat(path[end][None], len(ring), axis=0), points[end]])
        disc = disc if end == 0 else disc[::-1]
        flat = np.stack([np.zeros_like(ring), ring * [height, width]])
        flat = flat * [-1, 1] if end == 0 else flat[::-1]
        patches.append(_grid_patch(disc, flat, np.broadcast_to(normal, disc.shape), f"{name}/end"))
    return patches


@njit(cache=True, error_model="numpy")
def winding_numbers(points, triangles):
    """How often a closed surface of triangles (m, 3, 3) winds round each point: 1 inside, 0 outside."""
    result = np.zeros(len(points))
    for i in range(len(points)):
        total = 0.0
        for k in range(len(triangles)):
            a, b, c = triangles[k, 0] - points[i], triangles[k, 1] - points[i], triangles[k, 2] - points[i]
            la, lb, lc = np.sqrt((a * a).sum()), np.sqrt((b * b).sum()), np.sqrt((c * c).sum())
            det = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                   + a[2] * (b[0] * c[1] - b[1] * c[0]))
            total += np.arctan2(det, la * lb * lc + (a * b).sum() * lc + (b * c).sum() * la + (c * a).sum() * lb)
        result[i] = total / (2 * np.pi)
    return result


def join(parts):
    """Patches of several closed parts, without the triangles that lie wholly within another part."""
    solids = [np.concatenate([p.points[p.faces] for p in part]) for part in parts]
    joined = []
    for k, part in enumerate(parts):
        for patch in part:
            hidden = np.zeros(len(patch.points), bool)
            for j, solid in enumerate(solids):
                low, high = solid.min((0, 1)), solid.max((0, 1))
                near = ((patch.points > low) & (patch.points < high)).all(1) & (j != k)
                hidden[near] |= winding_numbers(patch.points[near], solid) > 0.5
            patch.faces = patch.faces[~hidden[patch.faces].all(1)]
            if len(patch.faces):
                joined.append(patch)
    return joined

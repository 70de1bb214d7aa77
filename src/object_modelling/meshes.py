"""Triangle meshes: what exporters ask of them."""
import numpy as np

MAX_CELLS_PER_AXIS = 2048


class Mesh:
    """vertices: n x 3; triangles: m x 3, counterclockwise from outside; normals: n x 3; colours: n x 3, RGB; uv: n x 2,
    v upwards; texture: BGR. All but the first two may be None; with a texture vertices stand double at its seams."""

    def __init__(self, vertices, triangles, normals=None, colours=None, uv=None, texture=None):
        self.vertices = np.asarray(vertices, float).reshape(-1, 3)
        self.triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
        self.normals, self.colours, self.uv, self.texture = normals, colours, uv, texture

    def scaled(self, factor):
        return Mesh(self.vertices * factor, self.triangles, self.normals, self.colours, self.uv, self.texture)

    def transformed(self, target_from_source):
        rotation, translation = target_from_source[:3, :3], target_from_source[:3, 3]
        normals = None if self.normals is None else self.normals @ rotation.T
        return Mesh(self.vertices @ rotation.T + translation, self.triangles, normals, self.colours, self.uv,
                    self.texture)

    def bounds(self):
        """(smallest, largest) coordinates"""
        return self.vertices.min(0), self.vertices.max(0)

    def is_closed(self):
        """Whether each edge has as many triangles on its one side as on the other."""
        edges = np.concatenate([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        count = len(self.vertices)
        there, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
        return np.array_equal(np.sort(there), np.sort(back))


def moments(mesh):
    """(volume, centre of mass, inertia about it for density 1) of what a closed mesh encloses."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6  # of the tetrahedra with the origin, signed
    volume = volumes.sum()
    centre = (volumes[:, None] * (a + b + c)).sum(0) / (4 * volume)
    second = sum(np.einsum("i,ij,ik->jk", volumes, p, p) for p in (a, b, c, a + b + c)) / 20
    second -= volume * np.outer(centre, centre)
    return volume, centre, np.trace(second) * np.eye(3) - second


def box(size, target_from_box):
    """A closed box of eight vertices."""
    corners = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)]) - 0.5
    triangles = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
                 (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    return Mesh(corners * size, triangles).transformed(np.asarray(target_from_box))


def _directions(subdivisions):
    """Unit vectors spread evenly: an icosahedron with each edge halved so many times."""
    golden = (1 + 5 ** 0.5) / 2
    points = [np.roll([0, s, t * golden], k) for k in range(3) for s in (-1, 1) for t in (-1, 1)]
    points = np.array(points) / np.hypot(1, golden)
    edge = 2 / np.hypot(1, golden)
    for _ in range(subdivisions):
        distances = np.linalg.norm(points[:, None] - points[None], axis=2)
        first, second = np.nonzero(np.triu((distances > 0) & (distances < 1.3 * edge)))
        middles = points[first] + points[second]
        points = np.concatenate([points, middles / np.linalg.norm(middles, axis=1, keepdims=True)])
        edge /= 2
    return points


def convex_hull(vertices, subdivisions=2):
    """Closed hull of the outermost points in 162 directions, at most 320 triangles; None for points of a plane."""
    vertices = np.asarray(vertices, float)
    points = vertices[np.unique(np.argmax(vertices @ _directions(subdivisions).T, axis=0))]
    tolerance = 1e-7 * np.ptp(points, axis=0).max()
    faces = _first_tetrahedron(points, tolerance)
    if faces is None:
        return None
    while True:
        a, b, c = (points[[face[i] for face in faces]] for i in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        heights = points @ normals.T - (normals * a).sum(1)
        outermost = np.argmax(heights.max(1))
        visible = heights[outermost] > tolerance
        if not visible.any():
            break
        edges = {(faces[f][i], faces[f][(i + 1) % 3]) for f in np.nonzero(visible)[0] for i in range(3)}
        faces = [face for face, seen in zip(faces, visible) if not seen]
        faces += [(i, j, outermost) for i, j in sorted(edges) if (j, i) not in edges]
    used, triangles = np.unique(np.array(faces), return_inverse=True)
    return Mesh(points[used], triangles.reshape(-1, 3))


def _first_tetrahedron(points, tolerance):
    first = np.argmin(points[:, 0])
    second = np.argmax(np.linalg.norm(points - points[first], axis=1))
    along = points[second] - points[first]
    off_line = np.linalg.norm(np.cross(points - points[first], along), axis=1)
    third = np.argmax(off_line)
    normal = np.cross(along, points[third] - points[first])
    heights = (points - points[first]) @ normal / max(np.linalg.norm(normal), 1e-300)
    fourth = np.argmax(np.abs(heights))
    if abs(heights[fourth]) <= tolerance:
        return None
    i, j, k = (first, second, third) if heights[fourth] < 0 else (first, third, second)
    return [(i, j, k), (j, i, fourth), (k, j, fourth), (i, k, fourth)]


def decimated(mesh, max_triangles):
    """Vertices of one cell of a grid become one, nearest to the planes of their triangles. Without texture."""
    if len(mesh.triangles) <= max_triangles:
        return mesh
    coarse, fine = 1, MAX_CELLS_PER_AXIS
    while fine - coarse > 1:
        cells = (coarse + fine) // 2
        if len(_kept_triangles(mesh, _clusters(mesh, cells)[0])) <= max_triangles:
            coarse = cells
        else:
            fine = cells
    return _clustered(mesh, coarse)


def _clusters(mesh, cells_per_axis):
    """(cluster of each vertex, how many vertices each has, size of a cell)"""
    low, high = mesh.bounds()
    cell_size = (high - low).max() / cells_per_axis
    cells = np.floor((mesh.vertices - low) / cell_size).astype(np.int64)
    keys = (cells[:, 0] * (2 * MAX_CELLS_PER_AXIS) + cells[:, 1]) * (2 * MAX_CELLS_PER_AXIS) + cells[:, 2]
    _, cluster, counts = np.unique(keys, return_inverse=True, return_counts=True)
    return cluster, counts, cell_size


def _kept_triangles(mesh, cluster):
    """Those whose corners are in three clusters, each but once."""
    triangles = cluster[mesh.triangles]
    triangles = triangles[np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)]
    low, middle, high = np.sort(triangles, axis=1).T
    count = int(cluster.max()) + 1
    _, first = np.unique((low * count + middle) * count + high, return_index=True)
    return triangles[np.sort(first)]


def _clustered(mesh, cells_per_axis):
    cluster, counts, cell_size = _clusters(mesh, cells_per_axis)
    used, triangles = np.unique(_kept_triangles(mesh, cluster), return_inverse=True)
    colours = None
    if mesh.colours is not None:
        colours = np.round(_sums(cluster, mesh.colours, len(counts)) / counts[:, None])[used].astype(np.uint8)
    positions = _cluster_positions(mesh, cluster, counts, cell_size)[used]
    reduced = Mesh(positions, triangles.reshape(-1, 3), colours=colours)
    reduced.normals = vertex_normals(reduced)
    return reduced


def _sums(index, values, count):
    return np.stack([np.bincount(index, column, count) for column in np.asarray(values, float).T], 1)


def _cluster_positions(mesh, cluster, counts, cell_size):
    """Least squares to the planes of the triangles at a cluster (their quadric), held near the mean of its vertices."""
    count = len(counts)
    means = _sums(cluster, mesh.vertices, count) / counts[:, None]
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)  # length: twice the area
    weights = np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    normals = normals / weights[:, None]
    planes, offsets, areas = np.zeros((count, 9)), np.zeros((count, 3)), np.zeros(count)
    for i in range(3):
        at = cluster[mesh.triangles[:, i]]
        distances = ((a - means[at]) * normals).sum(1)
        products = normals[:, :, None] * normals[:, None, :] * weights[:, None, None]
        planes += _sums(at, products.reshape(-1, 9), count)
        offsets += _sums(at, normals * (weights * distances)[:, None], count)
        areas += np.bincount(at, weights, count)
    systems = planes.reshape(-1, 3, 3) + np.eye(3) * (1e-2 * areas + 1e-300)[:, None, None]
    shifts = np.linalg.solve(systems, offsets[:, :, None])[:, :, 0]
    return means + np.clip(shifts, -cell_size, cell_size)


def vertex_normals(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    normals = sum(_sums(mesh.triangles[:, i], faces, len(mesh.vertices)) for i in range(3))
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

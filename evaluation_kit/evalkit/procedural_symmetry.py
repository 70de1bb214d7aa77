"""Rotations that leave an object as it is: of its shape alone, or of shape and texture; see objects/README.md."""

import numpy as np

from .geometry import rotation_from_axis_angle
from .mesh import ClosestPoint

ORDERS = (12, 10, 8, 6, 5, 4, 3, 2)
CONTINUOUS_DEG = (360 / 7, 360 / 11, 360 / 17, 180.0, 90.0)   # turns that a continuous symmetry must survive
SHAPE_TOLERANCE = 0.003    # of the diameter
COLOUR_TOLERANCE = 10.0    # grey levels
COLOUR_SHARE = 0.01        # of the surface may differ by more


class SymmetryFinder:
    """Finds the turns about the coordinate axes through the middle that leave a mesh as it is."""

    def __init__(self, mesh, samples=3000):
        self.mesh, self.closest = mesh, ClosestPoint(mesh)
        self.centre = (mesh.vertices.min(0) + mesh.vertices.max(0)) / 2
        self.tolerance = SHAPE_TOLERANCE * mesh.diameter()
        self.points, _, face, bary = mesh.sample(samples, np.random.default_rng(0))
        self.colour = mesh.colour_at(face, bary)

    def holds(self, axis, angle_deg, colour):
        """Whether a turn about an axis through the middle maps shape (and colour) onto itself."""
        rotation = rotation_from_axis_angle(axis, np.radians(angle_deg))
        turned = (self.points - self.centre) @ rotation.T + self.centre
        if self.closest.query(turned[::40])[0].max() > self.tolerance:   # most turns fail here, cheaply
            return False
        distance, closest, face = self.closest.query(turned)
        if distance.max() > self.tolerance:
            return False
        if not colour:
            return True
        there = self.mesh.colour_at(face, self._barycentric(closest, face))
        return bool((np.abs(there - self.colour).mean(1) > COLOUR_TOLERANCE).mean() < COLOUR_SHARE)

    def _barycentric(self, points, face):
        a, b, c = (self.mesh.vertices[self.mesh.faces[face, k]] for k in range(3))
        normal = np.cross(b - a, c - a)
        area = np.maximum((normal ** 2).sum(1), 1e-30)
        v = np.einsum("ij,ij->i", np.cross(points - a, c - a), normal) / area
        w = np.einsum("ij,ij->i", np.cross(b - a, points - a), normal) / area
        return np.clip(np.stack([1 - v - w, v, w], 1), 0, 1)

    def order(self, axis, colour):
        """Highest order of the symmetry about an axis: 0 if any turn will do, 1 if none."""
        if all(self.holds(axis, angle, colour) for angle in CONTINUOUS_DEG):
            return 0
        return next((n for n in ORDERS if self.holds(axis, 360 / n, colour)), 1)

    def entries(self, colour):
        """The list `symmetries` of an object.yaml."""
        axes = {axis: self.order(axis, colour) for axis in ((0, 0, 1), (1, 0, 0), (0, 1, 0))}
        found = sorted((a for a in axes if axes[a] != 1), key=lambda a: 1e9 if axes[a] == 0 else axes[a], reverse=True)
        if not found:
            return []
        first, others = found[0], found[1:]
        generators = [(first, axes[first])]
        if others:   # turns about two axes at right angles bring those about the third
            generators.append((others[0], 2))
        if len(others) == 2 and axes[first] == 4 and self.holds((1, 1, 1), 120, colour):
            generators.append(((1, 1, 1), 3))
        offset = [round(float(v), 6) for v in self.centre]
        return [{"axis": list(axis), "offset": list(offset), **({"order": order} if order else {})}
                for axis, order in generators]

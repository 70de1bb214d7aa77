"""What simulators and planners ask of an object: mass, inertia, collision geometry."""
import numpy as np

from object_modelling import meshes

DENSITY_KG_M3 = 500.0  # where the database has no mass


class Inertia:
    """mass_kg, center_m (object frame), matrix_kg_m2 (about the centre, object axes), of: whose volume."""

    def __init__(self, mass_kg, center_m, matrix_kg_m2, of):
        self.mass_kg, self.center_m, self.matrix_kg_m2, self.of = mass_kg, center_m, matrix_kg_m2, of

    def entries(self):
        """xx, xy, xz, yy, yz, zz"""
        return [(name, self.matrix_kg_m2["xyz".index(name[0]), "xyz".index(name[1])])
                for name in ("xx", "xy", "xz", "yy", "yz", "zz")]


def box_of(model):
    return meshes.box(model.size_m, model.model_from_box)


def inertia_of(model):
    """As the database tells; objects of before: of the mesh where it is closed, else of its hull, density uniform."""
    known = model.mass_properties
    if known:
        matrix = np.array(known["inertia_per_density_m5"], float).reshape(3, 3)
        density_kg_m3 = known["mass_kg"] / known["volume_m3"]
        return Inertia(float(known["mass_kg"]), np.array(known["center_of_mass_m"], float), matrix * density_kg_m3,
                       str(known["of"]))
    mesh, of = model.mesh(), "mesh"
    if not mesh.is_closed():
        mesh, of = meshes.convex_hull(mesh.vertices), "hull"
    if mesh is None:
        mesh, of = box_of(model), "box"
    volume_m3, center_m, per_density_m5 = meshes.moments(mesh)
    return Inertia(DENSITY_KG_M3 * volume_m3, center_m, DENSITY_KG_M3 * per_density_m5, of)


def collision_meshes(model):
    """Convex meshes: the database's parts, or the hull."""
    parts = model.collision_parts()
    if parts:
        return parts
    return [meshes.convex_hull(model.mesh().vertices) or box_of(model)]

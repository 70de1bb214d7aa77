import os

import numpy as np
import pytest
import yaml

from evalkit.mesh import Mesh, distinct_resting_poses, load_mesh
from evalkit.pose_error import ObjectModel
from evalkit.procedural import KINDS, STYLES, kind_of, style_of, write_object
from evalkit.procedural_shapes import can, carton
from evalkit.procedural_surface import extrude, join, lathe, rounded_outline, tube, winding_numbers
from evalkit.procedural_symmetry import SymmetryFinder

SEED = 7


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    """[(metadata, mesh path, mesh)] of two objects of each kind."""
    out = str(tmp_path_factory.mktemp("objects"))
    made = [write_object(out, SEED, k) for k in range(2 * len(KINDS))]
    paths = [os.path.join(out, m["name"], "textured.obj") for m in made]
    return [(m, p, load_mesh(p)) for m, p in zip(made, paths)]


def triangles(part):
    return np.concatenate([p.points[p.faces] for p in part])


def test_kinds_and_styles_come_in_their_shares():
    kinds = list(KINDS)
    assert sorted(kind_of(3, k, kinds) for k in range(12, 18)) == sorted(kinds)
    assert sorted(style_of(3, k) for k in range(20, 40)) == sorted(STYLES)


def test_the_same_seed_gives_the_same_bytes_and_another_does_not(tmp_path):
    for out, seed in (("a", 1), ("b", 1), ("c", 2)):
        write_object(str(tmp_path / out), seed, 5)
    folders = [next((tmp_path / out).iterdir()) for out in "abc"]
    for name in ("textured.obj", "textured.mtl", "texture.jpg", "object.yaml"):
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes()
    assert (folders[0] / "textured.obj").read_bytes() != (folders[2] / "textured.obj").read_bytes()


def test_objects_are_of_household_size_and_stand_in_two_poses(objects):
    for metadata, _, mesh in objects:
        extent = np.ptp(mesh.vertices, axis=0)
        assert 0.02 <= extent.max() <= 0.3001, metadata
        assert 1000 <= len(mesh.faces) <= 8000, metadata
        assert abs(mesh.vertices[:, 2].min()) < 1e-6
        assert len(distinct_resting_poses(mesh, 2)) == 2


def test_triangles_face_outwards_and_print_is_not_mirrored(objects):
    for metadata, _, mesh in objects:
        normals, area = mesh.face_normals_and_areas()
        agreement = np.einsum("mkd,md->mk", mesh.normals, normals).min(1)
        assert agreement[area > 1e-8].min() > 0.2, metadata
        a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0
        d1, d2 = mesh.uv[:, 1] - mesh.uv[:, 0], mesh.uv[:, 2] - mesh.uv[:, 0]
        assert (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])[area > 1e-8].min() > 0, metadata
        assert 0 <= mesh.uv.min() and mesh.uv.max() <= 1


@pytest.mark.parametrize("make", ["extrude", "lathe", "tube"])
def test_parts_are_closed(make):
    outline = rounded_outline([(0, 0), (0.1, 0), (0.1, 0.02), (0.03, 0.02), (0.03, 0.08), (0, 0.08)], 0.004, 0.002)
    part = {"extrude": lambda: extrude(outline, 0.01, 0.001, "plate", 0.002),
            "lathe": lambda: lathe([("a/bottom", [(0, 0), (1, 0)], False), ("a/side", [(1, 0), (1, 1)], True),
                                    ("a/top", [(1, 1), (0, 1)], True)]),
            "tube": lambda: tube([(0, 0, 0), (0.05, 0, 0.01), (0.1, 0, 0.04)], 0.01, 0.02, "rod")}[make]()
    surface = triangles(part)
    middle = surface.reshape(-1, 3).mean(0) if make != "extrude" else np.array([0.015, 0.01, 0.005])
    points = np.stack([middle, middle + 5 * np.ptp(surface.reshape(-1, 3), axis=0)])
    assert np.allclose(winding_numbers(points, surface), [1, 0], atol=1e-6)
    _, index = np.unique(np.round(surface.reshape(-1, 3), 7), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(1)]
    edges = {}
    for a, b, c in faces:
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] = edges.get(edge, 0) + 1
    assert all(edges.get((b, a)) == n == 1 for (a, b), n in edges.items())


def test_joined_parts_lose_what_is_inside():
    part = lathe([("a/bottom", [(0, 0), (1, 0)], False), ("a/side", [(1, 0), (1, 1)], True),
                  ("a/top", [(1, 1), (0, 1)], True)])
    rod = tube(np.linspace([0, 0, 0.5], [3, 0, 0.5], 31), 0.2, 0.2, "rod")
    points = np.concatenate([p.points[p.faces].reshape(-1, 3) for p in join([part, rod]) if "rod" in p.region])
    assert points[:, 0].min() > 0.8


def finder(shape):
    points = triangles(shape.patches)
    return SymmetryFinder(Mesh(points.reshape(-1, 3), np.arange(3 * len(points)).reshape(-1, 3)), samples=400)


def test_symmetries_of_shapes():
    assert [("order" in e, e["axis"]) for e in finder(can(np.random.default_rng(1))).entries(False)] == [
        (False, [0, 0, 1])]
    block = finder(carton(np.random.default_rng(1))).entries(False)
    assert [(e["order"], e["axis"]) for e in block] == [(2, [0, 0, 1]), (2, [1, 0, 0])]


def test_symmetries_that_are_written_hold(objects):
    for metadata, path, mesh in objects:
        assert metadata["symmetric"] == bool(metadata["symmetries"])
        model = ObjectModel(path)
        with open(os.path.join(os.path.dirname(path), "object.yaml")) as f:
            assert yaml.safe_load(f) == metadata
        for symmetry in model.symmetries:
            assert model.adds(np.eye(4), symmetry) < 0.003 * model.diameter


def test_print_breaks_the_symmetry_of_a_shape(objects):
    full = [m for m, _, _ in objects if m["print"] == "full" and m["kind"] in ("carton", "rounded_box", "can")]
    assert full and all(m["shape_symmetries"] and not m["symmetries"] for m in full)
    plain = [m for m, _, _ in objects if m["print"] == "plain" and m["kind"] in ("carton", "rounded_box", "can")]
    assert plain and all(m["shape_symmetries"] == m["symmetries"] for m in plain)

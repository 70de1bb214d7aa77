"""Moments, hull, decimation, symmetries and point clouds against numbers that are known."""
import os
import tempfile
import unittest

import numpy as np
import small_database
from object_modelling import mesh_files, meshes, pcd
from object_modelling.exporters import moveit, sdf, symmetries
from object_modelling.outcome import Failure


class MeshesTest(unittest.TestCase):
    def test_moments_of_a_box_anywhere(self):
        size = np.array([0.1, 0.2, 0.4])
        rotation = symmetries.rotation_about([1, 2, 3], 0.8)
        placed = np.eye(4)
        placed[:3, :3], placed[:3, 3] = rotation, [0.3, -2, 5]
        volume, centre, inertia = meshes.moments(meshes.box(size, placed))
        expected = np.prod(size) / 12 * np.diag([size[1] ** 2 + size[2] ** 2, size[0] ** 2 + size[2] ** 2,
                                                 size[0] ** 2 + size[1] ** 2])
        self.assertAlmostEqual(volume, np.prod(size), 12)
        np.testing.assert_allclose(centre, placed[:3, 3], atol=1e-9)
        np.testing.assert_allclose(inertia, rotation @ expected @ rotation.T, atol=1e-9)

    def test_closed_or_not(self):
        mesh = small_database.plain_box()
        self.assertTrue(mesh.is_closed())
        self.assertFalse(meshes.Mesh(mesh.vertices, mesh.triangles[1:]).is_closed())

    def test_the_hull_of_a_box_is_the_box(self):
        hull = meshes.convex_hull(small_database.plain_box().vertices)
        self.assertTrue(hull.is_closed())
        self.assertEqual(len(hull.vertices), 8)
        self.assertAlmostEqual(meshes.moments(hull)[0], np.prod(small_database.SIZE_M), 12)

    def test_hulls_are_closed_convex_and_near(self):
        random = np.random.RandomState(1)
        points = random.normal(size=(4000, 3))
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        for cloud in (points, points * [1, 0.1, 3], random.uniform(size=(50, 3))):
            hull = meshes.convex_hull(cloud)
            self.assertTrue(hull.is_closed())
            self.assertLessEqual(len(hull.triangles), 320)
            a, b, c = (hull.vertices[hull.triangles[:, i]] for i in range(3))
            normals = np.cross(b - a, c - a)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            heights = cloud @ normals.T - (normals * a).sum(1)
            self.assertLess(heights.max(), 0.05 * np.ptp(cloud, axis=0).max())
        self.assertIsNone(meshes.convex_hull(points * [1, 1, 0]))

    def test_decimation_keeps_shape_and_colour(self):
        mesh = small_database.plain_box(steps=40)
        reduced = meshes.decimated(mesh, 2000)
        self.assertLessEqual(len(reduced.triangles), 2000)
        self.assertGreater(len(reduced.triangles), 1000)
        self.assertAlmostEqual(meshes.moments(reduced)[0] / np.prod(small_database.SIZE_M), 1, 2)
        expected = 255 * (reduced.vertices / small_database.SIZE_M + 0.5)
        self.assertLess(np.abs(expected - reduced.colours).max(), 20)
        self.assertIs(meshes.decimated(mesh, 10 ** 6), mesh)

    def test_files_are_read_as_written(self):
        with tempfile.TemporaryDirectory() as folder:
            for write, read, mesh in ((mesh_files.ply, mesh_files.read_ply, small_database.plain_box()),
                                      (mesh_files.glb, mesh_files.read_glb, small_database.textured_box())):
                path = os.path.join(folder, "mesh")
                with open(path, "wb") as file:
                    file.write(write(mesh))
                found = read(path)
                for name in ("vertices", "triangles", "normals", "colours", "uv", "texture"):
                    if getattr(mesh, name) is not None:
                        np.testing.assert_allclose(getattr(found, name), getattr(mesh, name), atol=1e-6, err_msg=name)
                for size in (0, 3, 50, os.path.getsize(path) // 2):
                    with open(path, "r+b") as file:
                        file.truncate(size)
                    with self.assertRaisesRegex(Failure, "cannot be read"):
                        read(path)
            with self.assertRaisesRegex(Failure, "there is no mesh"):
                mesh_files.read_ply(os.path.join(folder, "none"))


class SymmetriesTest(unittest.TestCase):
    @staticmethod
    def turn(axis, order, point=(0, 0, 0)):
        return {"kind": "discrete", "axis": axis, "order": order, "point_m": list(point)}

    def test_groups_are_complete(self):
        z, x, diagonal = [0, 0, 1], [1, 0, 0], [1, 1, 1]
        for axes, count in (([], 0), ([self.turn(z, 4)], 3), ([self.turn(z, 2), self.turn(x, 2)], 3),
                            ([self.turn(z, 4), self.turn(x, 2)], 7), ([self.turn(z, 4), self.turn(diagonal, 3)], 23)):
            self.assertEqual(len(symmetries.discrete(axes)), count)

    def test_the_axis_stays(self):
        point = np.array([0.1, 0.2, 0.3])
        for turn in symmetries.discrete([self.turn([0, 0, 1], 6, point)]):
            np.testing.assert_allclose(turn[:3, :3] @ point + turn[:3, 3], point, atol=1e-12)

    def test_rotations_both_ways(self):
        for axis, angle in (([1, 0, 0], 3.1), ([0, 1, 0], np.pi / 2), ([1, -2, 0.5], 2.0), ([0, 0, 1], 0.0)):
            rotation = symmetries.rotation_about(axis, angle)
            roll, pitch, yaw = sdf.roll_pitch_yaw(rotation)
            again = (symmetries.rotation_about([0, 0, 1], yaw) @ symmetries.rotation_about([0, 1, 0], pitch) @
                     symmetries.rotation_about([1, 0, 0], roll))
            np.testing.assert_allclose(again, rotation, atol=1e-7)
            x, y, z, w = moveit.quaternion(rotation)
            vector = np.array([x, y, z])
            half = 2 * np.arctan2(np.linalg.norm(vector), w)
            again = symmetries.rotation_about(vector, half) if half > 0 else np.eye(3)
            np.testing.assert_allclose(again, rotation, atol=1e-7)


class PcdTest(unittest.TestCase):
    def test_copies_and_literals(self):
        packed = bytes([2]) + b"abc" + bytes([(1 << 5), 2]) + bytes([(7 << 5), 20, 0]) + bytes([0]) + b"z"
        # literals abc; 3 bytes from 3 back; 29 bytes from 1 back, overlapping; literal z
        expected = b"abc" + b"abc" + b"c" * 29 + b"z"
        self.assertEqual(bytes(pcd._decompress_lzf(packed, len(expected))), expected)  # pylint: disable=protected-access

    def test_damage_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "cloud.pcd")
            small_database.write_pcd(path, {"x": np.arange(100)}, (100, 1))
            columns, size = pcd.read(path)
            self.assertEqual(size, (100, 1))
            np.testing.assert_array_equal(columns["x"], np.arange(100))
            for length in (300, 40, 0):
                with open(path, "r+b") as file:
                    file.truncate(length)
                with self.assertRaisesRegex(Failure, "cloud.pcd cannot be read"):
                    pcd.read(path)


if __name__ == "__main__":
    unittest.main()

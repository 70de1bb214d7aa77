"""PLY to binary glTF: nothing lost, large meshes thinned, damaged files named."""
import json
import os
import struct
import tempfile
import unittest

import numpy as np

import object_folder
from object_modelling.report import mesh_glb
from object_modelling.report.object_data import ReportError


def parts(data):
    """(description, binary) of a GLB."""
    magic, version, total = struct.unpack("<4sII", data[:12])
    assert (magic, version, total) == (b"glTF", 2, len(data))
    length = struct.unpack("<I4s", data[12:20])[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


class GlbTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "mesh.ply")

    def test_mesh_comes_through(self):
        mesh = object_folder.box_mesh()
        object_folder.write_ply(self.path, *mesh)
        for read, written in zip(mesh_glb.read_ply(self.path), mesh):
            np.testing.assert_array_equal(read, written)
        description, binary = parts(mesh_glb.glb_of_ply(self.path))
        accessors = description["accessors"]
        primitive = description["meshes"][0]["primitives"][0]
        self.assertEqual(accessors[primitive["indices"]]["count"], 3 * len(mesh[3]))
        position = accessors[primitive["attributes"]["POSITION"]]
        np.testing.assert_allclose(position["max"], [0.04, 0.03, 0.06], atol=1e-6)
        view = description["bufferViews"][position["bufferView"]]
        first = np.frombuffer(binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]], "<f4")
        np.testing.assert_array_equal(first.reshape(-1, 3), mesh[0])
        self.assertTrue(all(view["byteOffset"] % 4 == 0 for view in description["bufferViews"]))

    def test_large_meshes_are_thinned_in_place(self):
        mesh = object_folder.box_mesh(40)
        vertices, normals, colours, triangles = mesh_glb.decimated(*mesh, max_triangles=3000)
        self.assertLessEqual(len(triangles), 3000)
        self.assertGreater(len(triangles), 1000)
        self.assertLess(triangles.max(), len(vertices))
        np.testing.assert_allclose(vertices.max(0), mesh[0].max(0), atol=0.003)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
        self.assertEqual(colours.dtype, np.uint8)
        self.assertEqual(len(mesh_glb.decimated(*mesh)[3]), len(mesh[3]))

    def test_damaged_files_are_named(self):
        object_folder.write_ply(self.path, *object_folder.box_mesh())
        with open(self.path, "rb") as file:
            whole = file.read()
        for damaged in (b"", b"rubbish", whole[:100], whole[:-5], whole.replace(b"binary_little", b"ascii_"),
                        whole.replace(b"element face", b"element fuss")):
            with open(self.path, "wb") as file:
                file.write(damaged)
            with self.assertRaisesRegex(ReportError, "mesh.ply"):
                mesh_glb.glb_of_ply(self.path)


if __name__ == "__main__":
    unittest.main()

"""Each format is read back by a loader that is not ours, and gives the box that went in."""
import os
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import cv2
import loaders
import numpy as np
import small_database
import yaml
from object_modelling.exporters import command
from small_database import SIZE_M

VOLUME_M3 = np.prod(SIZE_M)


class FormatCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = folder.name
        small_database.write_object(cls.root, "box", version_2=True)
        small_database.write_object(cls.root, "old", textured=False)

    def export(self, format_name, *names, **choices):
        folder, notes = command.export_objects(self.root, [], format_name, **choices)
        self.assertEqual(notes, [])
        return os.path.join(folder, *names)

    def assert_box(self, loaded, factor=1.0):
        np.testing.assert_allclose(loaded.extents(), factor * SIZE_M, rtol=1e-5)
        np.testing.assert_allclose(loaded.vertices.mean(0), 0, atol=1e-5 * factor)
        self.assertAlmostEqual(loaded.volume() / (factor ** 3 * VOLUME_M3), 1, 4)


class MeshFormatsTest(FormatCase):
    def assert_textured(self, loaded, picture, model_from_loaded=np.eye(3)):
        """At the corners of each triangle the texture has the colour of the box's side that the triangle is of."""
        height, width = picture.shape[:2]
        self.assertEqual(len(loaded.corners), 12)
        for corners in loaded.corners:
            vertices = loaded.vertices[corners[:, 0]] @ model_from_loaded.T
            axis, = np.nonzero(np.ptp(vertices, axis=0) < 1e-6)[0]
            side = 2 * axis + (vertices[0, axis] < 0)
            for u, v in loaded.uv[corners[:, 1]]:
                colour = picture[int((1 - v) * height), int(u * width)].tolist()
                self.assertEqual(colour, [40 * side, 255 - 40 * side, 100])

    def test_units(self):
        for format_name in ("ply", "obj", "stl"):
            for unit, factor in (("", 1), ("m", 1), ("mm", 1000)):
                for object_id in ("box", "old"):
                    path = self.export(format_name, object_id, object_id + "." + format_name, unit=unit)
                    self.assert_box(loaders.Loaded(path), factor)

    def test_textures(self):
        for format_name in ("ply", "obj"):
            path = self.export(format_name, "box", "box." + format_name)
            self.assert_textured(loaders.Loaded(path), cv2.imread(os.path.splitext(path)[0] + ".png"))
        with open(self.export("obj", "box", "box.mtl")) as text:
            self.assertIn("map_Kd box.png", text.read())

    def test_vertex_colours(self):
        loaded = loaders.Loaded(self.export("ply", "old", "old.ply"))
        expected = loaded.vertices / SIZE_M + 0.5
        np.testing.assert_allclose(loaded.colours, expected, atol=0.01)

    def test_glb_stands_upright(self):
        model_from_root = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # glTF has y up
        for object_id in ("box", "old"):
            loaded = loaders.Loaded(self.export("glb", object_id, object_id + ".glb"))
            np.testing.assert_allclose(loaded.extents(), SIZE_M[[0, 2, 1]], rtol=1e-5)
            self.assertAlmostEqual(loaded.volume() / VOLUME_M3, 1, 4)
        loaded = loaders.Loaded(self.export("glb", "box", "box.glb"))
        self.assert_textured(loaded, small_database.texture(), model_from_root)

    def test_centred(self):
        for extension in ("ply", "stl", "obj"):
            self.assert_box(loaders.Loaded(self.export("centred", "box", "box." + extension)))
        with open(self.export("centred", "box", "frame.yaml")) as text:
            np.testing.assert_allclose(yaml.safe_load(text)["centred_from_model"], np.eye(4), atol=1e-9)

    def test_grasping_pipeline(self):
        self.assert_box(loaders.Loaded(self.export("grasping_pipeline", "box.stl")), 1000)
        with open(self.export("grasping_pipeline", "models_metadata.yml")) as text:
            metadata = yaml.safe_load(text)
        self.assertEqual(sorted(metadata), ["box", "old"])
        np.testing.assert_allclose(metadata["box"]["extent"], SIZE_M)
        self.assertEqual((metadata["box"]["center"], metadata["box"]["rot"]), ([0, 0, 0], np.eye(3).tolist()))

    def test_m3t(self):
        body = cv2.FileStorage(self.export("m3t", "box", "box.yaml"), cv2.FILE_STORAGE_READ)
        np.testing.assert_array_equal(body.getNode("geometry2body_pose").mat(), np.eye(4))
        self.assertEqual(body.getNode("geometry_unit_in_meter").real(), 1)
        self.assertEqual(body.getNode("geometry_enable_culling").real(), 1)
        self.assert_box(loaders.Loaded(self.export("m3t", "box", body.getNode("geometry_path").string())))


class BodiesTest(FormatCase):
    def assert_inertia(self, inertial, mass, center, object_id):
        matrix = np.array([[float(inertial["i" + "".join(sorted(a + b))]) for b in "xyz"] for a in "xyz"])
        density = small_database.DENSITY_KG_M3 if object_id == "box" else 500
        squares = SIZE_M ** 2
        expected = density * VOLUME_M3 / 12 * np.diag(squares.sum() - squares)
        np.testing.assert_allclose(matrix, expected, rtol=1e-4, atol=1e-9)
        self.assertTrue((np.linalg.eigvalsh(matrix) > 0).all())
        self.assertAlmostEqual(float(mass) / (density * VOLUME_M3), 1, 5)
        np.testing.assert_allclose([float(value) for value in center.split()[:3]],
                                   [0.001, 0.002, 0.003] if object_id == "box" else [0, 0, 0], atol=1e-6)

    def assert_collision(self, paths, object_id):
        parts = [loaders.Loaded(path) for path in paths]
        self.assertEqual(len(parts), 2 if object_id == "box" else 1)
        self.assertAlmostEqual(sum(part.volume() for part in parts) / VOLUME_M3, 1, 4)

    def test_urdf(self):
        for object_id in ("box", "old"):
            path = self.export("urdf", object_id, object_id + ".urdf")
            link = ElementTree.parse(path).getroot().find("link")
            inertial = link.find("inertial")
            self.assert_inertia(inertial.find("inertia").attrib, inertial.find("mass").get("value"),
                                inertial.find("origin").get("xyz"), object_id)
            meshes = [mesh.get("filename") for mesh in link.findall("collision/geometry/mesh")]
            self.assert_collision([os.path.join(os.path.dirname(path), mesh) for mesh in meshes], object_id)
            visual = link.find("visual/geometry/mesh").get("filename")
            self.assert_box(loaders.Loaded(os.path.join(os.path.dirname(path), visual)))

    def test_urdf_is_accepted(self):
        self.assertIn("root Link: box", loaders.run("check_urdf", self.export("urdf", "box", "box.urdf")))

    def test_sdf(self):
        for object_id in ("box", "old"):
            path = self.export("sdf", object_id, "model.sdf")
            model = ElementTree.parse(path).getroot().find("model")
            inertial = model.find("link/inertial")
            self.assert_inertia({child.tag: child.text for child in inertial.find("inertia")},
                                inertial.findtext("mass"), inertial.findtext("pose"), object_id)
            np.testing.assert_allclose([float(value) for value in model.findtext("pose").split()],
                                       [0, 0, SIZE_M[2] / 2, 0, 0, 0], atol=1e-9)
            uris = [uri.text for uri in model.findall("link/collision/geometry/mesh/uri")]
            self.assertTrue(all(uri.startswith("model://%s/" % object_id) for uri in uris))
            exports = os.path.dirname(os.path.dirname(path))
            self.assert_collision([uri.replace("model:/", exports) for uri in uris], object_id)
            config = ElementTree.parse(os.path.join(os.path.dirname(path), "model.config")).getroot()
            self.assertEqual(config.findtext("description"), "A <box> & more")
            self.assertEqual(config.findtext("sdf"), "model.sdf")

    def test_sdf_is_accepted(self):
        self.assertIn("Valid", loaders.run("gz", "sdf", "-k", self.export("sdf", "box", "model.sdf")))

    def test_moveit(self):
        for object_id in ("box", "old"):
            with open(self.export("moveit", object_id, "collision_object.yaml")) as text:
                message = yaml.safe_load(text)
            volume = 0
            for mesh in message["meshes"]:
                vertices = np.array([[vertex[axis] for axis in "xyz"] for vertex in mesh["vertices"]])
                triangles = np.array([triangle["vertex_indices"] for triangle in mesh["triangles"]])
                a, b, c = (vertices[triangles[:, i]] for i in range(3))
                volume += np.einsum("ij,ij->", a, np.cross(b, c)) / 6
            self.assertAlmostEqual(volume / VOLUME_M3, 1, 5)
            self.assertEqual(len(message["mesh_poses"]), len(message["meshes"]))
            with open(self.export("moveit", object_id, "collision_object_box.yaml")) as text:
                message = yaml.safe_load(text)
            np.testing.assert_allclose(message["primitives"][0]["dimensions"], SIZE_M)
            self.assertEqual(message["primitive_poses"][0]["orientation"]["w"], 1)
            self.assertEqual((message["operation"], message["id"]), (0, object_id))

    def test_moveit_is_accepted(self):
        try:
            from moveit_msgs.msg import CollisionObject  # pylint: disable=import-outside-toplevel
        except ImportError:
            self.skipTest("moveit_msgs is not installed (Debian has no package of it)")
        import genpy  # pylint: disable=import-outside-toplevel
        with open(self.export("moveit", "box", "collision_object.yaml")) as text:
            genpy.message.fill_message_args(CollisionObject(), [yaml.safe_load(text)])


if __name__ == "__main__":
    unittest.main()

"""Every shipped launch file loads, starts its nodes, and passes on its arguments."""
import os
import unittest

import roslaunch.config
import roslaunch.xmlloader

LAUNCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "launch")
NODES = {"camera_tracker", "keyframe_store", "segmenter", "refiner", "session_aligner", "model_builder",
         "exporter", "modelling_manager"}


def load(name, *arguments):
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader(resolve_anon=True)
    loader.load(os.path.join(LAUNCH, name), config, argv=list(arguments), verbose=False)
    return config


def parameter(config, name):
    return config.params["/object_modelling/" + name].value


class LaunchFilesTest(unittest.TestCase):
    def test_all_of_them_are_tested(self):
        self.assertEqual(set(os.listdir(LAUNCH)), {"object_modelling.launch", "demo.launch", "alignment_review.launch",
                                                   "recognition.launch", "recognition_demo.launch"})

    def test_recognition(self):
        config = load("recognition.launch", "camera:=kinect", "database_path:=/d", "rate_hz:=2")
        self.assertEqual({node.name for node in config.nodes}, {"recogniser", "rviz_recognition"})
        self.assertEqual(parameter(config, "recogniser/database_path"), "/d")
        self.assertEqual(parameter(config, "recogniser/rate_hz"), 2)
        recogniser = [node for node in config.nodes if node.name == "recogniser"][0]
        self.assertTrue(recogniser.respawn)
        self.assertEqual(dict(recogniser.remap_args)["rgb/image_rect_color"], "/kinect/rgb/image_rect_color")
        self.assertEqual({node.name for node in load("recognition.launch", "rviz:=false").nodes}, {"recogniser"})
        config = load("recognition.launch", "rviz:=false", "adapter:=true")
        self.assertEqual({node.name for node in config.nodes}, {"recogniser", "recognition_adapter"})
        self.assertEqual(parameter(config, "recognition_adapter/cam_info_topic"), "")

    def test_recognition_demo(self):
        config = load("recognition_demo.launch", "scene:=/a scene", "database_path:=/d", "rviz:=false")
        self.assertEqual({(node.namespace, node.name) for node in config.nodes},
                         {("/object_modelling/", "recogniser"), ("/camera/", "play_scene")})
        self.assertEqual(parameter(config, "recogniser/database_path"), "/d")

    def test_nodes(self):
        config = load("object_modelling.launch")
        self.assertEqual({node.name for node in config.nodes}, NODES | {"rviz"})
        for node in config.nodes:
            self.assertEqual(node.namespace, "/object_modelling/")
            if node.package == "object_modelling":
                self.assertTrue(node.respawn, node.name)

    def test_without_rviz(self):
        self.assertEqual({node.name for node in load("object_modelling.launch", "rviz:=false").nodes}, NODES)

    def test_arguments_arrive(self):
        config = load("object_modelling.launch", "camera:=kinect", "reference:=object", "store_path:=/s",
                      "noise_model:=/n", "database_path:=/d")
        self.assertEqual(parameter(config, "camera_tracker/reference"), "object")
        self.assertEqual(parameter(config, "keyframe_store/store_path"), "/s")
        self.assertEqual(parameter(config, "camera_tracker/noise_model"), "/n")
        self.assertEqual(parameter(config, "segmenter/noise_model"), "/n")
        for node in ("model_builder", "exporter"):
            self.assertEqual(parameter(config, node + "/database_path"), "/d")
        tracker = [node for node in config.nodes if node.name == "camera_tracker"][0]
        remaps = dict(tracker.remap_args)
        self.assertEqual(remaps["rgb/image_rect_color"], "/kinect/rgb/image_rect_color")
        self.assertEqual(remaps["object_mask"], "/kinect/object_mask")

    def test_every_node_gets_its_config(self):
        config = load("object_modelling.launch")
        for key in ("camera_tracker/tracker/seed", "keyframe_store/preview/voxel_size_m", "segmenter/scene/min_height_m",
                    "refiner/bundle_adjustment/seed", "session_aligner/store/node", "model_builder/fusion/min_views",
                    "modelling_manager/service_wait_s", "exporter/database_path"):
            parameter(config, key)

    def test_alignment_review(self):
        node, = load("alignment_review.launch").nodes
        self.assertEqual((node.package, node.namespace), ("rviz", "/object_modelling/"))
        self.assertTrue(os.path.exists(node.args.split()[-1]), node.args)

    def test_demo(self):
        config = load("demo.launch", "recording:=/r", "object_id:=mug", "rviz:=false")
        self.assertEqual({node.name for node in config.nodes}, NODES | {"demo"})
        demo = [node for node in config.nodes if node.name == "demo"][0]
        self.assertEqual(demo.args, "/r --object-id mug")
        self.assertTrue(demo.required)
        self.assertEqual({node.name for node in load("demo.launch", "recording:=/r", "rviz:=false", "drive:=false").nodes},
                         NODES)


if __name__ == "__main__":
    unittest.main()

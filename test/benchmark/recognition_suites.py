#!/usr/bin/python3
"""Writes the suites of the kit that the confidence of the recogniser is fitted on: twelve YCB objects, none of them the
kit's own, in 24 images each of a Kinect, an active stereo camera and a time-of-flight camera. Also ids.json, the number
of each object in them.

    recognition_suites.py YCB_MESHES OUT     # YCB_MESHES/cracker_box/textured.obj, ...
"""

import argparse
import json
import os

import yaml

OBJECTS = ["bleach_cleanser", "bowl", "cracker_box", "foam_brick", "gelatin_box", "master_chef_can", "pitcher_base",
           "power_drill", "pudding_box", "rubiks_cube", "tuna_fish_can", "wood_block"]
DISTRACTORS = ["a_toy_airplane", "apple", "scissors"]
SENSORS = {
    "kinect": {"seeds": [2101, 2102, 2103, 2104]},
    "stereo": {"seeds": [2201, 2202, 2203, 2204], "image": {"width": 848, "height": 480, "focal_px": 612},
               "depth": {"model": "stereo"}},
    "tof": {"seeds": [2301, 2302, 2303, 2304], "image": {"width": 1280, "height": 720, "focal_px": 610},
            "depth": {"model": "tof", "dark": 0.02}},
}


def suite(meshes, settings):
    def mesh(name):
        return os.path.join(meshes, name, "textured.obj")

    return {
        "colour_format": "jpg",
        "objects": [{"mesh": mesh(name), "seed": 100 + number, "id": number}
                    for number, name in enumerate(OBJECTS, 1)],
        "distractors": [mesh(name) for name in DISTRACTORS],
        "sessions": False, "turntable": False, "jerky": False,
        "scenes": {"seeds": settings["seeds"], "views": 6, "objects": [3, 5], "instances": 3},
        **{part: settings[part] for part in ("image", "depth") if part in settings},
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", help="folder of the YCB meshes")
    parser.add_argument("out", help="folder for the suites")
    arguments = parser.parse_args()
    meshes = os.path.abspath(arguments.meshes)
    missing = [name for name in OBJECTS + DISTRACTORS if not os.path.isfile(os.path.join(meshes, name, "textured.obj"))]
    if missing:
        parser.error(f"no textured.obj in {meshes} of: {', '.join(missing)}")
    os.makedirs(arguments.out, exist_ok=True)
    for name, settings in SENSORS.items():
        with open(os.path.join(arguments.out, name + ".yaml"), "w") as file:
            yaml.safe_dump(suite(meshes, settings), file, sort_keys=False)
    with open(os.path.join(arguments.out, "ids.json"), "w") as file:
        json.dump({name: number for number, name in enumerate(OBJECTS, 1)}, file, indent=1)


if __name__ == "__main__":
    main()

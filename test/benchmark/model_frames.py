#!/usr/bin/python3
"""Writes the JSON file of --model-frames of score_recognition.py: T_mesh_model of every object of a database, against
the true mesh. Imported objects say it themselves; recorded ones are registered with the mesh, from the true poses of
their first session.

    model_frames.py DATABASE OUT [--numbers numbers.json] [--suite SUITE]
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import yaml

KIT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "evaluation_kit")
sys.path.insert(0, KIT)
from evalkit.dataset import Sequence  # noqa: E402, after the path
from evalkit.geometry import inverse  # noqa: E402


def registered(folder, description, suite):
    """T_mesh_model by score_model.py, which starts from the true pose of the session's first frame."""
    session = description["sessions"][0]
    sequence = Sequence(os.path.join(suite, os.path.basename(folder), session["id"]))
    truth = sequence.objects[0]
    start = (inverse(truth["T_world_object"].reshape(4, 4)) @ sequence.poses[0]
             @ inverse(np.array(session["model_from_session"]).reshape(4, 4)))
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        np.savetxt(file, start)
        file.flush()
        scored = subprocess.run([sys.executable, os.path.join(KIT, "score_model.py"),
                                 os.path.join(folder, "mesh", "mesh.ply"), truth["mesh"], "--init", file.name],
                                stdout=subprocess.PIPE, check=True)
    return np.array(json.loads(scored.stdout)["T_mesh_model"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("database")
    parser.add_argument("out")
    parser.add_argument("--numbers", help="JSON file: number by object id; else the digits that the id begins with")
    parser.add_argument("--suite", help="folder of the kit with the sessions, for recorded objects")
    arguments = parser.parse_args()
    numbers = {}
    if arguments.numbers:
        with open(arguments.numbers) as file:
            numbers = json.load(file)
    frames = {}
    for object_id in sorted(os.listdir(arguments.database)):
        folder = os.path.join(arguments.database, object_id)
        if not os.path.exists(os.path.join(folder, "object.yaml")):
            continue
        with open(os.path.join(folder, "object.yaml")) as file:
            description = yaml.safe_load(file)
        imported = description["provenance"].get("model_from_imported_mesh")
        if imported:
            frame = inverse(np.array(yaml.safe_load(str(imported)), float).reshape(4, 4))
        elif arguments.suite:
            frame = registered(folder, description, arguments.suite)
        else:
            parser.error(f"'{object_id}' was recorded: --suite says where its sessions and their truth are")
        number = numbers.get(object_id) or int("".join(c for c in object_id[:4] if c.isdigit()))
        frames[str(number)] = frame.tolist()
    with open(arguments.out, "w") as file:
        json.dump(frames, file)


if __name__ == "__main__":
    main()

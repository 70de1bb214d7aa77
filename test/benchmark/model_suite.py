#!/usr/bin/python3
"""Models from recordings with known objects, nothing given but the images: one table of accuracy, completeness and time.

Each RECORDING is a folder of the evaluation kit's simulator (its objects.yaml names the true mesh). The model comes from
`object_modelling model`, its figures from the kit's score_model.py.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import yaml

def name_of(path):
    return "_".join(path.rstrip("/").split("/")[-2:])


def true_mesh(recording, kit):
    with open(os.path.join(recording, "objects.yaml")) as text:
        objects = yaml.safe_load(text)
    objects = objects["objects"] if isinstance(objects, dict) else objects
    name = os.path.basename(os.path.dirname(objects[0]["mesh"]))
    return os.path.join(kit, "objects", name, "textured.obj")


def cell(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def build(arguments, recording, folder):
    name = name_of(recording)
    command = [arguments.command, "model", name, recording, "--database", folder, "--json", "--replace", *arguments.option]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{recording}: {done.stderr.strip().splitlines()[-1] if done.stderr else done.returncode}")
    return json.loads(done.stdout)


def score(arguments, recording, mesh):
    done = subprocess.run([sys.executable, os.path.join(arguments.eval, "score_model.py"), mesh,
                           true_mesh(recording, arguments.eval), "--session", recording],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    return json.loads(done.stdout)


def markdown(everything):
    lines = ["| recording | mean mm | sigma mm | 95 % mm | beyond 5 mm % | seen within 2 mm % | F at 1 mm, seen | colour error | "
             "seconds |", "|" + "---|" * 9]
    for name, result in everything.items():
        scored, stages = result["score"], result["model"]["build"]["stage_s"]
        accuracy = scored["accuracy_mm"]
        visible, f_score = scored["completeness_visible"]["2mm"], scored["fscore_visible"]["1mm"]
        cells = [name, cell(accuracy["mean"], 2), cell(accuracy["sigma"], 2), cell(accuracy["p95"], 2),
                 cell(100 * scored["outlier_fraction"], 2), cell(None if visible is None else 100 * visible, 1),
                 cell(f_score, 3), cell(scored["colour_error"], 1),
                 ", ".join(f"{stage} {seconds:.1f}" for stage, seconds in stages.items())]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--eval", required=True, help="folder of the evaluation kit")
    parser.add_argument("--command", default="object_modelling", help="the object_modelling program")
    parser.add_argument("--database", help="keep the models here")
    parser.add_argument("--option", action="append", default=[], help="passed on to `object_modelling model`")
    parser.add_argument("--json", help="also write everything to this file")
    arguments = parser.parse_args()
    everything = {}
    with tempfile.TemporaryDirectory() as scratch:
        for recording in arguments.recordings:
            try:
                built = build(arguments, recording, arguments.database or scratch)
            except RuntimeError as error:
                print(error, file=sys.stderr)
                continue
            mesh = os.path.join(built["build"]["object_folder"], "mesh", "mesh.ply")
            everything[name_of(recording)] = {"model": built, "score": score(arguments, recording, mesh)}
            print(f"{recording} done", file=sys.stderr)
    if arguments.json:
        with open(arguments.json, "w") as text:
            json.dump(everything, text, indent=1)
    print(markdown(everything))


if __name__ == "__main__":
    main()

"""Runs the object_modelling executable."""

import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))

COMMAND = os.environ["OBJECT_MODELLING_COMMAND"]
DATA = os.environ["OBJECT_MODELLING_TEST_DATA"]
CEREAL_BOX = os.path.join(DATA, "cereal_box_turntable")
CLUTTER = os.path.join(DATA, "clutter_simulated")
HANDHELD = os.path.join(DATA, "mustard_handheld_simulated")


def run(*arguments, timeout=500):
    """The finished process; stdout and stderr as text."""
    return subprocess.run([COMMAND, *arguments], universal_newlines=True, timeout=timeout,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run_json(*arguments, timeout=500):
    """The parsed result of a run that must succeed."""
    finished = run(*arguments, "--json", "--quiet", timeout=timeout)
    if finished.returncode != 0:
        raise AssertionError(f"exit code {finished.returncode}: {finished.stderr}")
    return json.loads(finished.stdout)

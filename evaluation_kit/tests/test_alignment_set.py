"""The sessions that make_alignment_set.py draws for an object."""

import argparse
import os

import pytest
from make_alignment_set import SENSORS, describe_object

OBJECTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "objects")
MESH = os.path.join(OBJECTS, "006_mustard_bottle", "textured.obj")


def arguments(**changes):
    settings = {"seed": 5, "sensors": [1.0, 0.0, 0.0], "third": 0.0, "repeat": 0.0, "duration": 10.0, "fps": 10.0,
                "sweep_deg": 390.0}
    return argparse.Namespace(**{**settings, **changes})


def resting(sequences):
    return [description["objects"][0]["resting"] for _, description in sequences]


def test_an_object_is_drawn_the_same_again_and_another_otherwise():
    first = describe_object(MESH, 3, arguments())
    assert first == describe_object(MESH, 3, arguments())
    assert first != describe_object(MESH, 4, arguments())
    assert first != describe_object(MESH, 3, arguments(seed=6))


def test_every_session_lies_otherwise():
    for number in range(5):
        poses = resting(describe_object(MESH, number, arguments(third=1.0)))
        assert len(poses) == len(set(poses)) == 3


def test_a_repeated_session_lies_as_one_before_but_looks_different():
    sequences = describe_object(MESH, 3, arguments(repeat=1.0))
    poses = resting(sequences)
    assert len(poses) == 3 and poses[2] in poses[:2]
    assert sequences[2][1]["seed"] != sequences[poses.index(poses[2])][1]["seed"]


@pytest.mark.parametrize("number,sensor", list(enumerate(SENSORS)))
def test_the_sensor_is_one_for_all_sessions_of_an_object(number, sensor):
    shares = [0.0, 0.0, 0.0]
    shares[number] = 1.0
    for _, description in describe_object(MESH, 3, arguments(sensors=shares)):
        assert description["depth"].get("model") == sensor

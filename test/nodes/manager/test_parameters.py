import dataclasses
import os
import unittest

import yaml

from object_modelling import parameters
from object_modelling.manager_options import ManagerOptions
from object_modelling.msg import Status
from object_modelling.outcome import Code

CONFIG = os.path.join(os.path.dirname(__file__), "..", "..", "..", "config", "modelling_manager.yaml")


@dataclasses.dataclass(frozen=True)
class Options:
    wait_s: float = 1.0
    count: int = 3
    label: str = ""
    on: bool = False


class ReadTest(unittest.TestCase):
    def test_defaults_and_values(self):
        self.assertEqual(parameters.read(Options, {}, "/n"), Options())
        self.assertEqual(parameters.read(Options, {"wait_s": 2, "on": True}, "/n"), Options(wait_s=2.0, on=True))

    def test_everything_wrong_is_listed(self):
        with self.assertRaises(parameters.ParameterError) as caught:
            parameters.read(Options, {"wait": 2, "count": 1.5, "on": 1, "wait_s": True}, "/n")
        for part in ("/n/wait: unknown", "/n/count", "/n/on", "/n/wait_s"):
            self.assertIn(part, str(caught.exception))

    def test_bounds(self):
        with self.assertRaises(parameters.ParameterError) as caught:
            parameters.read(ManagerOptions, {"service_wait_s": -1.0}, "/n")
        self.assertIn("/n/service_wait_s = -1", str(caught.exception))

    def test_shipped_config_is_the_default(self):
        with open(CONFIG) as stream:
            self.assertEqual(parameters.read(ManagerOptions, yaml.safe_load(stream), "/n"), ManagerOptions())


class CodesTest(unittest.TestCase):
    def test_numbers_of_the_message(self):
        for code in Code:
            self.assertEqual(getattr(Status, code.name), code)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(
    packages=["object_modelling", "object_modelling.adapters", "object_modelling.exporters",
              "object_modelling.report"], package_dir={"": "src"},
    package_data={"object_modelling.report": ["template.html", "viewer.js"]}))

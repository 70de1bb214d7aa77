#!/usr/bin/python3
from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=["object_modelling"], package_dir={"": "src"}))

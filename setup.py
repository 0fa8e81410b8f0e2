"""For catkin alone: the Python package afm_emulator (the client library). pip builds the module afm by
pyproject.toml."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['afm_emulator', 'afm_emulator.panel'], package_dir={'': 'python/client'}))

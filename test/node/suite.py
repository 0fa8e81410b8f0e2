#!/usr/bin/python3
"""Runs the tests of files NAME_test.py in one process, with one master. usage: suite.py NAME..."""
import sys
import unittest
from importlib import import_module
from pathlib import Path

import rospy
import rostest

ROOT = Path(__file__).resolve().parents[2]
# for own_master, terminal and tables
sys.path[:0] = [str(ROOT / folder) for folder in ('scripts', 'test/support', 'test/tools')]
NAMES = [argument for argument in sys.argv[1:] if argument.isidentifier()]  # the others are of roslaunch and rostest


def all_cases():
    load = unittest.defaultTestLoader.loadTestsFromModule
    return unittest.TestSuite(load(import_module(name + '_test')) for name in NAMES)


if __name__ == '__main__':
    rospy.init_node('test', anonymous=True)
    rostest.rosrun('afm_emulator', NAMES[0], '__main__.all_cases')

#!/usr/bin/python3
"""Runs roslaunch as a user does who presses Ctrl-C once all is there. Ends with 0 if roslaunch went on until then, and
ended.

usage: until_interrupted.py roslaunch ARGUMENT...
"""
import signal
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'node'))
from emulator_under_test import Launch  # noqa: E402
from topics import wait_until  # noqa: E402

STAYS_S = 1.0  # then: the first messages

launch = Launch(*sys.argv[2:])
try:
    wait_until(lambda: launch.child.poll() is not None or launch.has_started(), 'all nodes are there', deadline_s=90.0)
    time.sleep(STAYS_S)
    if launch.child.poll() is not None:
        sys.exit('until_interrupted: it ended by itself')
    launch.child.send_signal(signal.SIGINT)
    launch.wait(30.0)
finally:
    launch.clean_up()

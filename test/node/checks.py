"""Shared by the tests of recordings: the tools that check them."""
import subprocess

import roslib.packages

from emulator_under_test import PACKAGE
from topics import PATIENCE

SOUND, DIFFERS, USAGE, UNCHECKED = range(4)  # exit codes


class Answer:
    def __init__(self, tool, *arguments):
        binary = roslib.packages.find_node(PACKAGE, tool)[0]
        done = subprocess.run([binary] + [str(argument) for argument in arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=60 * PATIENCE)
        self.code, self.text = done.returncode, done.stdout


def replay_check(*arguments):
    return Answer('replay_check', *arguments)


def bag_check(*arguments):
    return Answer('bag_check', *arguments)


def assert_identical(test, *paths):
    """To the simulated run; and sound by itself."""
    for answer, word in ((replay_check(*paths), 'IDENTICAL'), (bag_check(*paths), 'SOUND')):
        test.assertEqual(answer.code, SOUND, answer.text)
        test.assertIn(word, answer.text)

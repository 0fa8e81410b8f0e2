"""Shared by the tests of recordings: the tools that check them."""
import contextlib
import importlib.util
import io
import runpy
import subprocess
from unittest import mock

from emulator_under_test import find
from topics import PATIENCE

SOUND, DIFFERS, USAGE, UNCHECKED = range(4)  # exit codes


class Answer:
    def __init__(self, code, text):
        self.code, self.text = code, text


def call(tool, *arguments):
    done = subprocess.run([find(tool)] + [str(argument) for argument in arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True, timeout=60 * PATIENCE)
    return Answer(done.returncode, done.stdout)


def replay_check(*arguments):
    return call('replay_check', *arguments)


def bag_check(*arguments):
    """In this process, which has what it imports already."""
    path, said, code = find('bag_check'), io.StringIO(), None
    with mock.patch('sys.argv', [path] + [str(argument) for argument in arguments]), \
            contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            runpy.run_path(path, run_name='__main__')
        except SystemExit as end:
            code = end.code
    return Answer(code, said.getvalue())


def assert_identical(test, *paths):
    """To the simulated run; and sound by itself."""
    for answer, word in ((replay_check(*paths), 'IDENTICAL'), (bag_check(*paths), 'SOUND')):
        test.assertEqual(answer.code, SOUND, answer.text)
        test.assertIn(word, answer.text)


def simulated_by_python(path):
    """Every epoch; none where the Python module is not built, as under a sanitizer."""
    if importlib.util.find_spec('afm') is None:
        return []
    import afm
    return [afm.from_bag(path, epoch=epoch).simulate() for epoch in afm.from_bag(path).epochs]

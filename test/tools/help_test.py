#!/usr/bin/python3
"""Every program with a command line answers --help, and refuses an option that it does not have."""
import subprocess
import sys
import unittest

PROGRAMS = []


def run(program, *arguments):
    return subprocess.run([program] + list(arguments), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True, timeout=20)


class Help(unittest.TestCase):
    def test_help(self):
        for program in PROGRAMS:
            answer = run(program, '--help')
            self.assertEqual((answer.returncode, answer.stderr), (0, ''), program)
            self.assertTrue(answer.stdout.startswith('Usage: ' + program.rsplit('/', 1)[1] + ' '), answer.stdout)

    def test_an_unknown_option_is_refused_by_name(self):
        for program in PROGRAMS:
            answer = run(program, '--no-such-option')
            self.assertEqual(answer.returncode, 2, program)
            self.assertIn("'--no-such-option'", answer.stderr)


if __name__ == '__main__':
    PROGRAMS = sys.argv[1:]
    assert PROGRAMS
    unittest.main(argv=sys.argv[:1])

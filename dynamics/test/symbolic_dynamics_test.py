#!/usr/bin/env python3
"""The tool symbolic_dynamics: its tables agree with each other, and what it refuses.

Usage: symbolic_dynamics_test.py TOOL
"""
import csv
import os
import sys
import tempfile
import unittest

from tables import run_tool

TOOL = None


def run(*arguments):
    return run_tool(TOOL, *arguments)


def read(path):
    with open(path) as file:
        return list(csv.DictReader(file))


class Tables(unittest.TestCase):
    def test_words_orbits_and_section(self):
        with tempfile.TemporaryDirectory() as directory:
            paths = {name: os.path.join(directory, name) for name in ('orbits', 'section', 'forbidden')}
            code, rows, report = run('--eta', '3.2', '--impacts', '50000', '--max-length', '4', '--guesses', '200',
                                     *[part for name in paths for part in ('--' + name, paths[name])])
            self.assertEqual(code, 0)
            self.assertIn('exponent of an impact: 0.2', report)
            self.assertEqual(int(rows[0]['words']), 4)
            forbidden = [row['word'] for row in read(paths['forbidden'])]
            self.assertEqual(len(forbidden), sum(int(row['forbidden']) for row in rows))
            section = read(paths['section'])
            self.assertEqual(len(section), 20000)
            letters = ''.join(row['letter'] for row in section)
            self.assertFalse([word for word in forbidden if word in letters])
            self.assertEqual(section[0]['phase_next'], section[1]['phase'])
            attractor = [row for row in read(paths['orbits']) if float(row['approach']) < 0.1]
            self.assertEqual([row['length'] for row in attractor], ['1', '3', '4'])
            self.assertEqual({row['orbits_with_it'] for row in attractor}, {'1'})

    def test_refuses(self):
        for word, arguments in (('model = oscillator', ['--model', 'oscillator']), ('eta = 0', ['--eta', '0']),
                                ('gamma = 7', ['--gamma', '7']), ('--max-length', ['--max-length', '0'])):
            code, rows, complaint = run(*arguments)
            self.assertEqual((code, rows), (2, []))
            self.assertIn(word, complaint)
        self.assertEqual(run('--impacts', '2000', '--section', '/no/such/place')[0], 1)


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

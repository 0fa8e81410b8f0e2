#!/usr/bin/env python3
"""The tools continue_orbits, bifurcations and return_scan: their tables, and what they refuse.

Usage: orbit_tools_test.py DIRECTORY_OF_THE_TOOLS
"""
import os
import sys
import unittest

from tables import run_tool

TOOLS = None


def run(tool, *arguments):
    return run_tool(os.path.join(TOOLS, tool), *arguments)


class Continue(unittest.TestCase):
    def test_the_orbit_at_eta_2_dies_in_a_graze(self):
        code, rows, _ = run('continue_orbits', '--eta', '2', '--vary', 'gamma', '--to', '0.1', '--guesses', '100')
        self.assertEqual(code, 0)
        graze = [row for row in rows if row['event'] == 'grazing']
        self.assertEqual(len(graze), 1)
        self.assertAlmostEqual(float(graze[0]['value']), 0.305677576, delta=1e-8)
        self.assertEqual(rows[-1]['event'], 'end: grazing')

    def test_refuses(self):
        for arguments in (['--vary', 'mass', '--to', '1'], ['--eta', '0', '--to', '1'], []):
            self.assertEqual(run('continue_orbits', *arguments)[0], 2)


class Hammer(unittest.TestCase):
    def test_every_tool_takes_it(self):
        code, rows, _ = run('continue_orbits', '--eta', '2', '--vary', 'gamma', '--to', '0.6', '--guesses', '50',
                            '--model', 'hammer')
        self.assertEqual((code, rows[-1]['event']), (0, 'end: target'))
        self.assertAlmostEqual(float(rows[-1]['multiplier_1_re']), 0.6, delta=1e-6)
        code, rows, _ = run('bifurcations', '--range', '2:2:1', '--impacts', '5', '--model', 'hammer')
        self.assertEqual({row['extension'] for row in rows}, {'0'})
        code, rows, _ = run('return_scan', '--eta', '2.7', '--model', 'hammer', '--points', '20', '--length', '1')
        self.assertEqual((code, len(rows)), (0, 400))


class Bifurcations(unittest.TestCase):
    def test_impacts_on_a_period_one(self):
        code, rows, _ = run('bifurcations', '--range', '1.9:2:0.05', '--impacts', '5')
        self.assertEqual((code, len(rows)), (0, 15))
        self.assertEqual({row['attractor'] for row in rows}, {'period-1'})
        self.assertAlmostEqual(float(rows[-1]['phase']), 0.75, delta=1e-9)

    def test_refuses(self):
        for arguments in (['--range', '1:2'], ['--vary', 'mass'], ['--sweep', 'left'], ['--model', 'anvil']):
            self.assertEqual(run('bifurcations', *arguments)[0], 2)


class Scan(unittest.TestCase):
    def test_the_nearest_return_is_at_the_fixed_point(self):
        code, rows, _ = run('return_scan', '--points', '40', '--depth', '36')
        self.assertEqual((code, len(rows)), (0, 1600))
        nearest = min(rows, key=lambda row: float(row['distance']))
        self.assertAlmostEqual(float(nearest['phase']), 0.529, delta=0.02)
        self.assertAlmostEqual(float(nearest['w']), 2.088, delta=0.2)


if __name__ == '__main__':
    TOOLS = sys.argv.pop(1)
    unittest.main()

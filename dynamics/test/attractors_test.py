#!/usr/bin/env python3
"""The tool attractors: its table, and what it refuses.

Usage: attractors_test.py TOOL
"""
import sys
import unittest

from tables import run_tool

TOOL = None


def run(*arguments):
    return run_tool(TOOL, *arguments)


class Table(unittest.TestCase):
    def test_two_attractors_at_one_drag_velocity(self):
        code, rows, _ = run('--eta', '3.75', '--cutoff', '0.375', '--starts', '40', '--friction-duration', '200')
        self.assertEqual(code, 0)
        self.assertGreaterEqual(len(rows), 2)
        self.assertAlmostEqual(sum(float(row['basin']) for row in rows), 1.0, delta=1e-12)
        self.assertIn('period-1', [row['attractor'] for row in rows])
        exponents = [float(row['lyapunov_1']) for row in rows]
        self.assertLess(min(exponents), -0.01)
        self.assertGreater(max(exponents), 0.01)
        self.assertGreater(len({row['k_f'] for row in rows}), 1)

    def test_the_closed_form_at_eta_2(self):
        _, rows, _ = run('--eta', '2', '--starts', '20', '--friction-duration', '200')
        self.assertEqual(rows[0]['attractor'], 'period-1')
        self.assertAlmostEqual(float(rows[0]['k_f']), 6.0610520411, delta=1e-8)

    def test_the_hammer(self):
        _, rows, _ = run('--eta', '2', '--model', 'hammer', '--starts', '5', '--friction-duration', '200')
        self.assertEqual(rows[0]['attractor'], 'period-1')
        self.assertAlmostEqual(float(rows[0]['k_f']), 8.27333702260941, delta=1e-11)
        self.assertEqual(rows[0]['lyapunov_3'], '-inf')

    def test_any_number_of_threads_gives_the_same_table(self):
        grid = ['--eta', '1:3:0.5', '--gamma', '0.6:0.7:0.1', '--starts', '2', '--friction-duration', '50',
                '--relative-cutoff', '--cutoff', '0.1']
        one = run(*grid, '--threads', '1')
        self.assertEqual(one, run(*grid, '--threads', '3'))
        self.assertGreaterEqual(len(one[1]), 10)
        self.assertEqual(float(one[1][0]['cutoff']), 0.1)


class Refused(unittest.TestCase):
    def refuse(self, word, *arguments):
        code, rows, complaint = run(*arguments)
        self.assertEqual((code, rows), (2, []))
        self.assertIn(word, complaint)

    def test_bad_parameters(self):
        self.refuse('gamma = 1.5', '--gamma', '1.5')
        self.refuse('eta = 1:2', '--eta', '1:2')
        self.refuse('eta = 2000', '--eta', '2000')
        self.refuse('cutoff = -1', '--cutoff', '-1')
        self.refuse('--starts', '--starts', '0')
        self.refuse('model = anvil', '--model', 'anvil')


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

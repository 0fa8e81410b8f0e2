#!/usr/bin/env python3
"""The tool model_error: what is known of its numbers otherwise, and what it refuses.

Usage: model_error_test.py TOOL
"""
import math
import sys
import unittest

from tables import run_tool

TOOL = None
QUICK = ['--starts', '1', '--duration', '200', '--transient', '200']
SLOPE = 2.0 * math.pi * 0.05 / 0.52


def run(*arguments):
    code, rows, report = run_tool(TOOL, *arguments)
    return code, [{key: float(text) if key not in ('model', 'attractor', 'reference_attractor') else text
                   for key, text in row.items()} for row in rows], report


class Errors(unittest.TestCase):
    def test_of_the_reference_itself_there_is_none(self):
        code, rows, _ = run('--model', 'oscillator', '--contact-tolerance', '1e-5', '--eta', '2:3.4:1.4', *QUICK)
        self.assertEqual((code, len(rows)), (0, 2))
        for row in rows:
            self.assertEqual((row['k_f_error'], row['deflection_error']), (0.0, 0.0))
            self.assertLess(row['tracking_error'], 1e-9)
            self.assertEqual(row['attractor'], row['reference_attractor'])

    def test_of_the_hammer_at_even_eta_is_the_closed_form(self):
        _, rows, _ = run('--eta', '4', *QUICK)
        self.assertAlmostEqual(rows[0]['k_f_error'], SLOPE * SLOPE, delta=1e-9)  # 1 + s^2 times the oscillator's
        self.assertGreater(rows[0]['tracking_error'], 0.01)
        self.assertGreater(rows[0]['deflection_error'], 0.01)
        self.assertGreater(rows[0]['stretch_max'], rows[0]['stretch_rms'])

    def test_of_bursts_is_within_their_tolerance(self):
        _, rows, _ = run('--model', 'oscillator', '--eta', '3', '--cutoff', '0.15', '--reference-tolerance', '0',
                         *QUICK)
        self.assertLess(abs(rows[0]['k_f_error']), 1e-2)
        self.assertGreater(rows[0]['cost_ratio'], 0.0)


class Refused(unittest.TestCase):
    def test_bad_parameters(self):
        for word, arguments in (('eta = 0', ['--eta', '0']), ('frequency_ratio = -1', ['--frequency-ratio', '-1']),
                                ('model = anvil', ['--model', 'anvil']), ('gamma = 2', ['--gamma', '2']),
                                ('eta = 1:2', ['--eta', '1:2']), ('--starts', ['--starts', '0'])):
            code, rows, complaint = run(*arguments)
            self.assertEqual((code, rows), (2, []), arguments)
            self.assertIn(word, complaint)


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

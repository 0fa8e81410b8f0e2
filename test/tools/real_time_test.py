#!/usr/bin/env python3
"""The program real_time refuses what it cannot measure.

Usage: real_time_test.py PROGRAM
"""
import sys
import unittest

from tables import run_tool

PROGRAM = None
SHORT = ['--eta', '2', '--cutoff', '0.05', '--tau', '3', '--transient', '1']


class RealTime(unittest.TestCase):
    def test_refusals(self):
        for option, value, *words in (
                ('eta', 'nan'), ('eta', 'inf'), ('eta', '1001', 'at most 1000'),
                ('eta', '1:2:-1', 'STEP must be above'),
                ('eta', '0:9:0', 'above 0'), ('eta', '0:9:1e-12', 'more than a million'),
                ('tau', '0'), ('tau', '-1'), ('tau', '1e30'), ('tau', '9000000000000000000'), ('transient', '-1'),
                ('tolerance', '5'), ('tolerance', 'nan'), ('tolerance', '-1'),
                ('temperature', '1', 'needs a quality factor'), ('quality-factor', '0.01'), ('kicks-per-tau', '0'),
                ('rest-height', 'nan'), ('rest-height', '3', 'hovers'), ('amplitude', '5'), ('cutoff', '-1'),
                ('frequency-ratio', '0'), ('model', 'spring', 'must be oscillator or hammer')):
            with self.subTest(option=option, value=value):
                code, rows, complaint = run_tool(PROGRAM, '--%s=%s' % (option, value))
                self.assertEqual((code, rows), (2, []), complaint)
                self.assertEqual(complaint.count('\n'), 1, complaint)
                for word in (option + ' = ', value, *words):
                    self.assertIn(word, complaint)

    def test_numbers_and_ranges(self):
        rows = run_tool(PROGRAM, *SHORT[2:], '--eta', '0:2:1', '4', '5,6')[1]
        self.assertEqual([row['eta'] for row in rows], ['0', '1', '2', '4', '5', '6'])
        self.assertEqual(rows[0]['k_f'], 'nan')  # as of friction_curve

    def test_the_hammer_has_its_own_friction(self):
        _, hammer, complaint = run_tool(PROGRAM, *SHORT, '--model', 'hammer')
        self.assertNotEqual(hammer[0]['k_f'], run_tool(PROGRAM, *SHORT)[1][0]['k_f'], complaint)
        self.assertEqual(hammer[0]['k_f'],  # without a lateral spring, its stiffness means nothing
                         run_tool(PROGRAM, *SHORT, '--model', 'hammer', '--frequency-ratio', '21')[1][0]['k_f'])


if __name__ == '__main__':
    PROGRAM = sys.argv.pop(1)
    unittest.main()

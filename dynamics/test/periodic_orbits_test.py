#!/usr/bin/env python3
"""The tool periodic_orbits: its table, and what it refuses.

Usage: periodic_orbits_test.py TOOL
"""
import sys
import unittest

from tables import run_tool

TOOL = None
QUICK = ['--trajectory', '20000', '--guesses', '200']


def run(*arguments):
    return run_tool(TOOL, *arguments)


class Table(unittest.TestCase):
    def test_orbits_at_the_papers_parameters(self):
        code, rows, report = run('--eta', '3.4', '--gamma', '0.7', '--max-length', '4', *QUICK)
        self.assertEqual(code, 0)
        self.assertEqual([row['length'] for row in rows], ['1', '1', '3', '4'])
        self.assertEqual(list(rows[0])[:9], 'length,cells,period,k_f,residual,phase,extension,u,w'.split(','))
        self.assertEqual(len(rows[0]), 17)
        paper = rows[1]
        self.assertAlmostEqual(float(paper['k_f']), 0.22902622884216517, delta=1e-15)
        self.assertAlmostEqual(float(paper['w']), 2.0880897958488404, delta=3e-15)
        self.assertAlmostEqual(float(paper['multiplier_1_re']), -0.5274355542, delta=1e-9)
        self.assertAlmostEqual(float(paper['multiplier_1_im']), 1.396024991, delta=1e-9)
        for row in rows:
            self.assertLess(float(row['residual']), 1e-13)
            sizes = [abs(complex(float(row['multiplier_%d_re' % i]), float(row['multiplier_%d_im' % i])))
                     for i in range(1, 5)]
            self.assertTrue(all(a > b * (1 - 1e-9) for a, b in zip(sizes, sizes[1:])))
        self.assertIn('length 2: ', report)

    def test_the_hammer(self):
        code, rows, _ = run('--eta', '4', '--max-length', '1', '--model', 'hammer', *QUICK)
        self.assertEqual((code, len(rows[0])), (0, 17))
        even = min(rows, key=lambda row: abs(float(row['phase']) - 0.75))
        self.assertAlmostEqual(float(even['k_f']), 8.27333702260941, delta=1e-12)
        self.assertEqual((even['extension'], even['multiplier_3_re']), ('0', '0'))

    def test_the_same_command_gives_the_same_table(self):
        arguments = ['--eta', '2.5', '--max-length', '3', *QUICK, '--quiet']
        self.assertEqual(run(*arguments), run(*arguments))


class Refused(unittest.TestCase):
    def refuse(self, word, *arguments):
        code, rows, complaint = run(*arguments)
        self.assertEqual((code, rows), (2, []))
        self.assertIn(word, complaint)

    def test_bad_parameters(self):
        self.refuse('gamma = 1.5', '--gamma', '1.5')
        self.refuse('cutoff = -1', '--cutoff', '-1')
        self.refuse('eta = ', '--eta', 'inf')
        self.refuse('eta = 0', '--eta', '0')
        self.refuse('--max-length', '--max-length', '0')
        self.refuse('model = spring', '--model', 'spring')


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

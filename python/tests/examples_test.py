#!/usr/bin/python3
"""Every example in Python runs, small, and draws its picture.

Usage: examples_test.py EXAMPLES     (their folder)
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

EXAMPLES = Path(sys.argv[1] if len(sys.argv) > 1 else '.').resolve()
LEVER = [str(EXAMPLES.parents[1] / 'config' / file) for file in ('levers/soft.yaml', 'surfaces/mica.yaml')]
SMALL = {'friction_peaks': ['20'], 'bifurcations': ['5'], 'thermal_histogram': ['100000'],
         'friction_of_lever': LEVER + ['1e-10', '20']}
BY_A_TEST_OF_ITS_OWN = {'read_bag', 'many_machines'}  # a recording; a cluster


class Examples(unittest.TestCase):
    def test_each(self):
        self.assertEqual({path.stem for path in EXAMPLES.glob('*.py')}, set(SMALL) | BY_A_TEST_OF_ITS_OWN)
        for name, arguments in SMALL.items():
            with self.subTest(name):
                output = self.run_example(name, arguments)
                if name == 'thermal_histogram':
                    # 100000 samples in 90 bins differ by 0.01 from their own distribution
                    self.assertLess(float(re.search(r'distance (\S+)', output).group(1)), 0.02)

    def run_example(self, name, arguments):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(EXAMPLES / (name + '.py'))] + arguments, cwd=folder, timeout=120,
                                  env=dict(os.environ, MPLBACKEND='Agg', MPLCONFIGDIR=folder), stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, universal_newlines=True)
            self.assertEqual(done.returncode, 0, done.stdout)
            picture = Path(folder) / (name + '.png')
            self.assertTrue(picture.exists() and picture.stat().st_size > 5000)
            return done.stdout


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

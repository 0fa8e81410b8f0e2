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
SPRINGS = 'spring_constant_n_per_m: 0.2\nlateral_spring_constant_n_per_m: 80.0\n'
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

    def test_a_wrong_lever_is_refused_in_a_line(self):
        good, surface = LEVER
        with tempfile.TemporaryDirectory() as folder:
            def file(text):
                path = Path(folder) / ('wrong%d.yaml' % len(os.listdir(folder)))
                path.write_text(text)
                return str(path)
            for arguments, words in (([file('')], 'a key and a number'), ([file('- 1')], 'a key and a number'),
                                     ([file('resonance_hz: high')], 'a key and a number'), ([file('a: [')], '.yaml: '),
                                     ([file('quality_factor: 100')], 'must have'),
                                     ([file(SPRINGS + 'resonance_hz: 1:30')], 'a key and a number'),
                                     ([file(SPRINGS + 'resonance_hz: 13e3')], 'a quality_factor above 0'),
                                     ([file(SPRINGS + 'resonance_hz: 13e3\nrestitution_gamma: 0.5')],
                                      'says nothing of its lever by restitution_gamma'), ([surface], 'must have'),
                                     ([good, file('lattice_spacing_m: 4.0e-10')], 'surface_amplitude_m'),
                                     ([good, file('lattice_spacing_m: 0.4\nsurface_amplitude_m: 5.0e-11')],
                                      'lattice_spacing_m = 0.4'),
                                     (['nosuch'], 'nosuch.yaml'), ([folder + '/no.yaml'], 'no.yaml'),
                                     ([good, surface, 'abc'], "load_n: invalid float value: 'abc'"),
                                     ([good, surface, '1'], 'load_n = 1')):
                done = subprocess.run([sys.executable, str(EXAMPLES / 'friction_of_lever.py')] + arguments, cwd=folder,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertNotIn('Traceback', done.stdout)
                self.assertIn(words, done.stdout.splitlines()[-1])

    def test_a_lever_by_its_frequencies(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / 'lever.yaml'
            path.write_text('omega_v_rad_per_s: 4.0e4\nomega_h_rad_per_s: 250e3\ntip_mass_kg: 4e-10\n'
                            'quality_factor: 100\nlateral_quality_factor: 50\n')
            self.run_example('friction_of_lever', [str(path), 'mica', '0', '20'])

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

#!/usr/bin/env python3
"""The tools of the laboratory: their tables, and what they refuse.

Usage: studies_test.py DIRECTORY_OF_THE_TOOLS
"""
import csv
import math
import os
import subprocess
import sys
import tempfile
import unittest

from tables import run_tool

TOOLS = None
SLOPE = 2.0 * math.pi * 0.05 / 0.52
ORBITS = ['--trajectory', '20000', '--guesses', '200']
SHORT = ['--starts', '1', '--duration', '200', '--transient', '200']

# tool: (what it names, arguments)
REFUSED = {
    'attractors': [('gamma = 1.5', '--gamma 1.5'), ('eta = 1:2', '--eta 1:2'), ('eta = 2000', '--eta 2000'),
                   ('cutoff = -1', '--cutoff -1'), ('--starts', '--starts 0'), ('model = anvil', '--model anvil')],
    'continue_orbits': [('mass', '--vary mass --to 1'), ('eta = 0', '--eta 0 --to 1'), ('to', ''),
                        ('to = nan', '--to nan'), ('to = 2000', '--to 2000'),
                        ('to = 1.5', '--vary gamma --to 1.5'), ('to = 1.5', '--si --vary gamma --to 1.5'),
                        ('to = 0.01', '--si --to 0.01')],
    'model_error': [('eta = 0', '--eta 0'), ('eta = 1:2', '--eta 1:2'), ('gamma = 2', '--gamma 2'),
                    ('frequency-ratio = -1', '--frequency-ratio -1'), ('--starts', '--starts 0'),
                    ('model = anvil', '--model anvil'), ('gamma: not with --scene', '--scene glide --gamma 0.5')],
    'periodic_orbits': [('gamma = 1.5', '--gamma 1.5'), ('cutoff = -1', '--cutoff -1'), ('eta = ', '--eta inf'),
                        ('eta = 0', '--eta 0'), ('--max-length', '--max-length 0'), ('model = anvil', '--model anvil')],
    'symbolic_dynamics': [('gamma = 7', '--gamma 7'), ('eta = 0', '--eta 0'), ('--max-length', '--max-length 0'),
                          ('model = oscillator', '--model oscillator')]}


def run(tool, *arguments):
    return run_tool(os.path.join(TOOLS, tool), *arguments)


def multipliers(row):
    return [complex(float(row['multiplier_%d_re' % i]), float(row['multiplier_%d_im' % i])) for i in range(1, 5)]


class Refusals(unittest.TestCase):
    def test_bad_input_is_named(self):
        for tool, cases in REFUSED.items():
            for words, arguments in cases:
                with self.subTest(tool=tool, arguments=arguments):
                    code, rows, complaint = run(tool, *arguments.split())
                    self.assertEqual((code, rows), (2, []))
                    self.assertIn(words, complaint)

    def test_an_output_that_cannot_be_written_is_told_before_the_search(self):
        for tool, option in (('symbolic_dynamics', '--orbits'), ('symbolic_dynamics', '--section'),
                             ('symbolic_dynamics', '--forbidden'), ('periodic_orbits', '--averages')):
            code, rows, complaint = run(tool, option, '/there/is/no/such/folder', '--max-length', '8')
            self.assertEqual((code, rows), (1, []), tool)
            self.assertIn('cannot write /there/is/no/such/folder', complaint)

    def test_without_chaos_there_are_no_words(self):
        with tempfile.NamedTemporaryFile('w+', suffix='.csv') as before:
            before.write('of an earlier run')
            before.flush()
            code, rows, complaint = run('symbolic_dynamics', '--eta', '2', '--max-length', '3', '--impacts', '20000',
                                        '--section', before.name)
            before.seek(0)
            self.assertEqual(before.read(), 'of an earlier run')
        self.assertEqual((code, rows), (1, []))
        self.assertIn('without chaos', complaint)


class Attractors(unittest.TestCase):
    few = ['--starts', '2', '--friction-duration', '50', '--relative-cutoff', '--cutoff', '0.1']

    def test_any_number_of_threads_gives_the_same_table(self):
        grid = ['--eta', '1:3:0.5', '--gamma', '0.6:0.7:0.1', *self.few]
        one = run('attractors', *grid, '--threads', '1')
        self.assertEqual(one, run('attractors', *grid, '--threads', '3'))
        self.assertGreaterEqual(len(one[1]), 10)
        self.assertEqual(float(one[1][0]['cutoff']), 0.1)

    def test_a_period_has_impacts_a_circle_a_rotation_number_and_rest_contact(self):
        _, rows, _ = run('attractors', '--eta', '1:2.5:0.5', '--gamma', '0.6', *self.few)
        of_kind = {row['attractor']: row for row in rows}
        period = of_kind['period-4']
        self.assertEqual((period['impacts'], period['cells'], period['contact_share']), ('4', '3', '0'))
        self.assertGreater(float(of_kind['quasi-periodic']['rotation_number']), 0.0)
        self.assertGreater(float(of_kind['contact']['contact_share']), 0.9)

    def test_a_relative_cutoff_is_the_same_dragged_forth_and_back(self):
        _, rows, _ = run('attractors', '--eta', '-2:2:4', *self.few)
        self.assertEqual({(row['eta'], float(row['cutoff'])) for row in rows}, {('-2', 0.2), ('2', 0.2)})


class Orbits(unittest.TestCase):
    def test_orbits_at_the_papers_parameters(self):
        code, rows, report = run('periodic_orbits', '--eta', '3.4', '--gamma', '0.7', '--max-length', '4', *ORBITS)
        self.assertEqual(code, 0)
        self.assertEqual([row['length'] for row in rows], ['1', '1', '3', '4'])
        self.assertEqual(list(rows[0])[:9], 'length,cells,period,k_f,residual,phase,extension,u,w'.split(','))
        self.assertEqual(len(rows[0]), 17)
        for column, value in (('k_f', 0.22902622884216517), ('w', 2.0880897958488404),
                              ('multiplier_1_re', -0.5274355542), ('multiplier_1_im', 1.396024991)):
            self.assertAlmostEqual(float(rows[1][column]), value, delta=1e-9)
        for row in rows:
            sizes = [abs(multiplier) for multiplier in multipliers(row)]
            self.assertTrue(all(a > b * (1 - 1e-9) for a, b in zip(sizes, sizes[1:])))
        self.assertIn('length 2: ', report)

    def test_averages_begin_with_the_one_orbit_of_an_impact_on_the_attractor(self):
        with tempfile.NamedTemporaryFile('r', suffix='.csv') as file:
            _, (_, orbit), _ = run('periodic_orbits', '--max-length', '1', '--averages', file.name, *ORBITS)
            first = {row['method']: row for row in csv.DictReader(file)}
        a, b, c, d = multipliers(orbit)
        for method, weight in (('zeta', abs(a * b)), ('determinant', abs((1 - a) * (1 - b) * (1 - c) * (1 - d)))):
            self.assertAlmostEqual(float(first[method]['k_f']), float(orbit['k_f']), delta=1e-12)
            self.assertAlmostEqual(float(first[method]['conservation']), 1.0 - 1.0 / weight, delta=1e-9)

    def test_a_bifurcation_is_named_by_its_multipliers_or_impacts(self):
        miss = {'saddle-node': lambda row: min(abs(m - 1.0) for m in multipliers(row)),
                'period doubling': lambda row: min(abs(m + 1.0) for m in multipliers(row)),
                'torus': lambda row: min(abs(abs(m) - 1.0) + (m.imag == 0.0) for m in multipliers(row)),
                'corner': lambda row: abs(float(row['slowest_impact']) - 0.05),
                'grazing': lambda row: min(float(row['slowest_impact']) / 5.0, float(row['clearance']))}
        ways = ['--eta 3.4 --length 4 --to 5', '--eta 2 --to 1']
        rows = [row for way in ways for row in run('continue_orbits', *way.split(), '--guesses', '100')[1]]
        self.assertEqual({row['event'] for row in rows}, {'', *miss, 'end: grazing'})
        for row in rows:
            self.assertLess(miss.get(row['event'], lambda row: 0.0)(row), 1e-3, row)

    def test_a_cutoff_that_varies_passes_the_speed_of_the_impacts_until_the_steps_are_spent(self):
        _, rows, _ = run('continue_orbits', '--eta', '2', '--vary', 'cutoff', '--to', '1000', '--guesses', '50')
        corner, = [row for row in rows if row['event'] == 'corner']
        self.assertAlmostEqual(float(corner['value']), 4.0 * SLOPE / (0.3 * math.hypot(1.0, SLOPE)), delta=1e-8)
        self.assertEqual(rows[-1]['event'], 'end: steps spent')

    def test_orbits_that_turn_back_to_gamma_1_are_lost_there(self):
        _, rows, _ = run('continue_orbits', '--eta', '4.5', '--length', '3', '--vary', 'gamma', '--to', '0')
        self.assertEqual(rows[-1]['event'], 'end: lost')
        self.assertAlmostEqual(float(rows[-1]['value']), 1.0, delta=1e-9)

    def test_every_tool_takes_the_hammer(self):
        hammer = ['--model', 'hammer']
        _, rows, _ = run('attractors', '--eta', '2', '--starts', '5', '--friction-duration', '200', *hammer)
        self.assertEqual((rows[0]['attractor'], rows[0]['lyapunov_3']), ('period-1', '-inf'))
        _, rows, _ = run('periodic_orbits', '--eta', '4', '--max-length', '1', *hammer, *ORBITS)
        even = min(rows, key=lambda row: abs(float(row['phase']) - 0.75))
        self.assertEqual((even['extension'], even['multiplier_3_re']), ('0', '0'))
        _, rows, _ = run('continue_orbits', '--eta', '2', '--vary', 'gamma', '--to', '0.6', '--guesses', '50', *hammer)
        self.assertEqual(rows[-1]['event'], 'end: target')
        self.assertAlmostEqual(float(rows[-1]['multiplier_1_re']), 0.6, delta=1e-6)


class ModelErrors(unittest.TestCase):
    def test_a_scene_is_a_file_by_its_ending_and_has_no_bath(self):
        with tempfile.TemporaryDirectory() as directory, open(os.path.join(directory, 'mine.yaml'), 'w') as scene:
            scene.write('lateral_quality_factor: 20.0\n')
            scene.flush()
            done = subprocess.run([os.path.abspath(os.path.join(TOOLS, 'model_error')), '--scene', 'mine.yaml'],
                                  cwd=directory, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn('scene = mine.yaml: it has a bath', done.stderr)

    def errors(self, *arguments):
        code, rows, _ = run('model_error', *arguments, *SHORT)
        self.assertEqual(code, 0)
        return [{key: text if key in ('model', 'attractor', 'reference_attractor') else float(text)
                 for key, text in row.items()} for row in rows]

    def test_a_long_path_of_a_scene_cuts_no_row(self):
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, 'a' * 150 + '.yaml')
            with open(path, 'w') as scene:
                scene.write('drag_velocity: 6.6208456e-06\n')
            code, rows, _ = run('model_error', '--scene', path, '--duration', '10')
        self.assertEqual((code, {row['scene'] for row in rows}), (0, {path}))
        self.assertEqual({row['in_use'] for row in rows} - {'0', '1'}, set())

    def test_of_the_reference_itself_there_is_none(self):
        rows = self.errors('--model', 'oscillator', '--contact-tolerance', '1e-5', '--eta', '2:3.4:1.4')
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertEqual((row['k_f_error'], row['deflection_error']), (0.0, 0.0))
            self.assertLess(row['tracking_error'], 1e-9)
            self.assertEqual(row['attractor'], row['reference_attractor'])

    def test_of_the_hammer_at_even_eta_is_the_closed_form(self):
        row, = self.errors('--eta', '4')
        self.assertAlmostEqual(row['k_f_error'], SLOPE * SLOPE, delta=1e-9)  # 1 + s^2 times the oscillator's
        self.assertGreater(row['tracking_error'], 0.01)
        self.assertGreater(row['deflection_error'], 0.01)
        self.assertGreater(row['extension_max'], row['extension_rms'])

    def test_of_bursts_is_within_their_tolerance(self):
        row, = self.errors('--model', 'oscillator', '--eta', '3', '--cutoff', '0.15', '--reference-tolerance', '0')
        self.assertLess(abs(row['k_f_error']), 1e-2)
        self.assertGreater(row['cost_ratio'], 0.0)


class Symbols(unittest.TestCase):
    def test_words_orbits_and_section_agree(self):
        with tempfile.TemporaryDirectory() as directory:
            paths = {name: os.path.join(directory, name) for name in ('orbits', 'section', 'forbidden')}
            outputs = [word for name in paths for word in ('--' + name, paths[name])]
            code, rows, report = run('symbolic_dynamics', '--eta', '3.2', '--impacts', '50000', '--max-length', '4',
                                     '--guesses', '200', *outputs)
            tables = {}
            for name, path in paths.items():
                with open(path) as file:
                    tables[name] = list(csv.DictReader(file))
        self.assertEqual(code, 0)
        self.assertIn('exponent of an impact: 0.2', report)
        self.assertEqual(int(rows[0]['words']), 4)
        forbidden, section = [row['word'] for row in tables['forbidden']], tables['section']
        self.assertEqual(len(forbidden), sum(int(row['forbidden']) for row in rows))
        self.assertEqual(len(section), 20000)
        letters = ''.join(row['letter'] for row in section)
        self.assertFalse([word for word in forbidden if word in letters])
        self.assertEqual(section[0]['phase_next'], section[1]['phase'])
        self.assertEqual(section[0]['gap_rate_next'], section[1]['gap_rate'])
        self.assertTrue(all(float(row['spread']) < float(row['largest_spread']) for row in rows))
        attractor = [row for row in tables['orbits'] if float(row['approach']) < 0.1]
        self.assertEqual([row['length'] for row in attractor], ['1', '3', '4'])
        self.assertEqual({row['orbits_with_it'] for row in attractor}, {'1'})
        self.assertEqual([row['cells'] for row in attractor], ['2', '4', '6'])


if __name__ == '__main__':
    TOOLS = sys.argv.pop(1)
    unittest.main()

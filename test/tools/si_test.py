#!/usr/bin/env python3
"""--si of the tools: the same numbers in other units, by columns that name them; nothing else changes. --lever,
--surface and --load: the model that follows from them.

Usage: si_test.py FOLDER_OF_THE_TOOLS
"""
import math
import os
import sys
import tempfile
import unittest

from tables import run_tool

FOLDER = None
A, OMEGA_V, MASS, BOLTZMANN = 0.52e-9, 40e3, 408e-12, 1.380649e-23
TAU = 2 * math.pi / OMEGA_V
SPEED = A / TAU
UNITS = {'_kg_per_s': MASS / TAU, '_m_per_s': SPEED, '_per_s': 1 / TAU, '_j': MASS * SPEED ** 2, '_m': A, '_s': TAU}
KELVIN = BOLTZMANN / (MASS * SPEED ** 2)  # m_tip a^2/tau^2
OTHER_NAMES = {'drag_velocity': 'eta'}
QUICK = ['--trajectory', '20000', '--guesses', '200', '--quiet']


def run(tool, *arguments, text=None):
    return run_tool(os.path.join(FOLDER, tool), *map(str, arguments), text=text)


def unit_of(column):
    """Its name without the unit, and the unit."""
    for suffix, unit in UNITS.items():
        if column.endswith(suffix):
            return column[:-len(suffix)], unit
    return column, 1


class SameNumbers(unittest.TestCase):
    def compare(self, natural, si, with_units, tolerance=1e-12):
        """Column by column, in the same order. with_units: the columns that have one."""
        self.assertEqual((natural[0], si[0], len(natural[1])), (0, 0, len(si[1])), natural[2] + si[2])
        self.assertTrue(si[1])
        names = [unit_of(column) for column in si[1][0]]
        self.assertEqual([OTHER_NAMES.get(name, name) for name, _ in names], list(natural[1][0]))
        self.assertEqual({column for column in si[1][0] if unit_of(column)[1] != 1}, set(with_units))
        for row, other in zip(natural[1], si[1]):
            for (name, unit), value, converted in zip(names, row.values(), other.values()):
                if value != converted:
                    expected = float(value) * unit
                    self.assertAlmostEqual(float(converted), expected, delta=tolerance * abs(expected) + 1e-300,
                                           msg=name)

    def test_friction_curve(self):
        columns = ['drag_velocity_m_per_s', 'cutoff_m_per_s', 'k_f_kg_per_s', 'k_f_std_error_kg_per_s',
                   'mean_energy_loss_j', 'mean_flight_time_s', 'largest_lyapunov_per_s', 'rest_height_m',
                   'amplitude_m', 'k_f_work_kg_per_s', 'k_f_work_std_error_kg_per_s']
        common = ['--duration', 200, '--transient', 100, '--eta', 2]
        si = ['--duration', 200 * TAU, '--transient', 100 * TAU, '--eta', 2, '--si']
        self.compare(run('friction_curve', *common), run('friction_curve', *si), columns)

    def test_options_of_friction_curve_are_taken_in_si(self):
        """The table gives them back, and the run is that of their natural values: an orbit, so that rounding does not
        grow."""
        scale = ['--lattice-spacing', 4e-10, '--omega-v', 5e4, '--tip-mass', 2e-10]
        speed = 4e-10 * 5e4 / (2 * math.pi)
        given = {'drag_velocity_m_per_s': 2 * speed, 'cutoff_m_per_s': 0.1 * speed, 'rest_height_m': -8e-12,
                 'amplitude_m': 4e-11}
        code, rows, complaint = run('friction_curve', '--si', *scale, '--drag-velocity', '%.15g' % (2 * speed),
                                    '--cutoff', '%.15g' % (0.1 * speed), '--rest-height', -8e-12, '--amplitude', 4e-11)
        self.assertEqual(code, 0, complaint)
        for column, value in given.items():
            self.assertAlmostEqual(float(rows[0][column]) / value, 1, delta=2e-15, msg=column)
        natural = run('friction_curve', '--eta', 2, '--cutoff', 0.1, '--rest-height', -0.02, '--amplitude', 0.1)[1][0]
        self.assertAlmostEqual(float(rows[0]['k_f_kg_per_s']) / (2e-10 * 5e4 / (2 * math.pi)), float(natural['k_f']),
                               delta=1e-6)

    def test_room_temperature_in_kelvin(self):
        arguments = ['friction_curve', '--eta', 2, '--quality-factor', 100, '--duration', 300 * TAU, '--si']
        code, rows, _ = run(*arguments, '--temperature', 300)
        natural = run('friction_curve', '--eta', 2, '--quality-factor', 100, '--duration', 300, '--temperature',
                      repr(300 * KELVIN))
        self.assertEqual(code, 0)
        self.assertAlmostEqual(float(rows[0]['k_f_work_kg_per_s']) / (MASS / TAU), float(natural[1][0]['k_f_work']),
                               delta=0.3)

    def test_periodic_orbits(self):
        arguments = ['periodic_orbits', '--eta', 3.4, '--max-length', 1, *QUICK]
        self.compare(run(*arguments), run(*arguments, '--si'),
                     ['period_s', 'k_f_kg_per_s', 'extension_m', 'u_m_per_s', 'w_m_per_s'])

    def test_continue_orbits(self):
        arguments = ['--eta', 3.4, '--guesses', 100]
        self.compare(run('continue_orbits', *arguments, '--to', 3.5),
                     run('continue_orbits', *arguments, '--to', repr(3.5 * SPEED), '--si'),
                     ['value_m_per_s', 'k_f_kg_per_s', 'slowest_impact_m_per_s', 'clearance_m'], tolerance=1e-6)

    def test_attractors(self):
        self.compare(run('attractors', '--eta', 2, '--starts', 2, '--friction-duration', 100),
                     run('attractors', '--eta', 2, '--starts', 2, '--friction-duration', repr(100 * TAU), '--si'),
                     ['drag_velocity_m_per_s', 'cutoff_m_per_s', 'k_f_kg_per_s', 'k_f_std_error_kg_per_s',
                      'lyapunov_1_per_s', 'lyapunov_2_per_s', 'lyapunov_3_per_s', 'lyapunov_4_per_s', 'extension_m',
                      'y_m', 'u_m_per_s', 'w_m_per_s'], tolerance=1e-6)

    def test_a_range_of_drag_velocities(self):
        code, rows, complaint = run('attractors', '--drag-velocity', '6.6e-6:6.7e-6:1e-7', '--starts', 1,
                                    '--friction-duration', 50 * TAU, '--si')
        self.assertEqual((code, [row['drag_velocity_m_per_s'] for row in rows]),
                         (0, ['6.6000000000000003e-06', '6.7000000000000002e-06']), complaint)

    def test_a_share_of_eta_has_no_unit(self):
        """It was divided by that of a speed."""
        share = ['attractors', '--eta', 2, '--starts', 1, '--relative-cutoff', '--cutoff', 0.1]
        natural, si = run(*share), run(*share, '--si')
        self.assertEqual((natural[0], si[0], len(natural[1])), (0, 0, len(si[1])), natural[2] + si[2])
        for row, other in zip(natural[1], si[1]):
            self.assertEqual(float(row['cutoff']), 0.2)
            self.assertAlmostEqual(float(other['cutoff_m_per_s']) / SPEED, 0.2, delta=1e-12)

    def test_next_impact(self):
        natural = 'eta,gamma,cutoff,phase,extension,u,w\n3.4,0.7,0.05,0.25,0.1,3.4,2\n'
        si = ('drag_velocity_m_per_s,gamma,cutoff_m_per_s,phase,extension_m,u_m_per_s,w_m_per_s\n' +
              ','.join(repr(v) for v in (3.4 * SPEED, 0.7, 0.05 * SPEED, 0.25, 0.1 * A, 3.4 * SPEED, 2 * SPEED)) + '\n')
        self.compare(run('next_impact', text=natural), run('next_impact', '--si', text=si),
                     ['drag_velocity_m_per_s', 'cutoff_m_per_s', 'extension_m', 'u_m_per_s', 'w_m_per_s', 'dt_s',
                      'extension_next_m', 'u_next_m_per_s', 'w_next_m_per_s', 'normal_speed_m_per_s',
                      'tangential_velocity_m_per_s', 'energy_loss_j'], tolerance=1e-11)
        # the header says which it is: a table in other units is refused
        code, rows, complaint = run('next_impact', '--si', text=natural)
        self.assertEqual((code, rows), (1, []))
        self.assertIn('drag_velocity_m_per_s', complaint)


class Levers(unittest.TestCase):
    """The files of the emulator, in natural units by hand: m = k / (2 pi f0)^2, tau = 1 / f0, y0 = -load / k."""
    K, F0, K_H, A, LOAD = 0.2, 13e3, 88.2, 3.99e-10, 0.1e-9
    GIVEN = ['--lever', 'ppp_cont', '--surface', 'nacl', '--load', LOAD]
    NATURAL = {'amplitude': 5e-11 / A, 'frequency-ratio': math.sqrt(K_H / K), 'rest-height': -LOAD / (K * A),
               'cutoff': 1.66e-7 / (A * F0), 'quality-factor': 100.0}

    def test_friction_curve(self):
        theta = BOLTZMANN * 300 / (self.K / (2 * math.pi) ** 2 * self.A ** 2)
        speed = 3 * self.A * self.F0
        given = [*self.GIVEN, '--drag-velocity', speed, '--temperature', 300]
        code, rows, complaint = run('friction_curve', '--si', *given)
        self.assertEqual(code, 0, complaint)
        options = [word for name, value in self.NATURAL.items() for word in ('--' + name, repr(value))]
        expected = run('friction_curve', '--eta', 3, *options, '--kicks-per-tau', 12.979, '--temperature', theta)[1][0]
        unit = self.K / (4 * math.pi ** 2 * self.F0)  # k = m (2 pi)^2 / tau^2
        for name in ('k_f', 'k_f_work'):
            error = float(expected[name + '_std_error'])
            self.assertAlmostEqual(float(rows[0][name + '_kg_per_s']) / unit, float(expected[name]), delta=5 * error)
            self.assertLess(error, 0.1 * float(expected[name]))
        for column, scale in (('rest_height_m', self.A), ('amplitude_m', self.A), ('frequency_ratio', 1)):
            natural = float(expected[column.replace('_m', '')])
            self.assertAlmostEqual(float(rows[0][column]) / scale / natural, 1, delta=1e-14, msg=column)
        self.assertAlmostEqual(float(rows[0]['cutoff_m_per_s']), 1.66e-7, delta=1e-20)

    def test_orbits_and_impacts(self):
        options = [word for name, value in self.NATURAL.items() if name not in ('cutoff', 'quality-factor')
                   for word in ('--' + name, repr(value))]
        of_point = ['--eta', 10, '--max-length', 1, *QUICK]
        si = run('periodic_orbits', '--si', *self.GIVEN, *of_point)
        natural = run('periodic_orbits', '--cutoff', repr(self.NATURAL['cutoff']), *options, *of_point)
        self.assertEqual((si[0], natural[0], len(si[1])), (0, 0, len(natural[1])), si[2] + natural[2])
        self.assertGreater(len(si[1]), 0)
        for row, other in zip(si[1], natural[1]):
            self.assertAlmostEqual(float(row['period_s']) * self.F0, float(other['period']), delta=1e-9)
            self.assertAlmostEqual(float(row['extension_m']) / self.A, float(other['extension']), delta=1e-6)
        speed = self.A * self.F0
        si = run('next_impact', '--si', *self.GIVEN, text=(
            'drag_velocity_m_per_s,gamma,cutoff_m_per_s,phase,extension_m,u_m_per_s,w_m_per_s\n%r,0.7,%r,0.25,0,%r,%r\n'
            % (3 * speed, 0.05 * speed, 3 * speed, 2 * speed)))
        natural = run('next_impact', *options,
                      text='eta,gamma,cutoff,phase,extension,u,w\n3,0.7,0.05,0.25,0,3,2\n')
        self.assertEqual((si[0], natural[0]), (0, 0), si[2] + natural[2])
        self.assertAlmostEqual(float(si[1][0]['dt_s']) * self.F0, float(natural[1][0]['dt']), delta=1e-12)
        for fault, *words in (('lever, surface, load: ', '--lever', 'ppp_cont'), ('rest-height = 3e-09: ', '--si',
                              '--rest-height', '3e-9'), ('frequency-ratio = -1: ', '--frequency-ratio', '-1')):
            code, _, complaint = run('next_impact', *words, text='eta,gamma,cutoff,phase,extension,u,w\n')
            self.assertEqual(code, 2, words)
            self.assertIn(fault, complaint)

    def test_real_time(self):
        short = ['real_time', '--eta', 2, '--tau', 20, '--transient', 10]
        row, = run(*short, *self.GIVEN)[1]
        for name, value in self.NATURAL.items():
            self.assertAlmostEqual(float(row[name.replace('-', '_')]) / value, 1, delta=1e-14, msg=name)
        ratio = float(row['lever_times_real_time']) / float(row['times_real_time'])
        self.assertAlmostEqual(ratio, 1 / (self.F0 * TAU), delta=1e-3)
        self.assertNotIn('lever_times_real_time', run(*short, '--cutoff', 0.1)[1][0])
        self.assertEqual([row['amplitude'] for row in run(*short, '--lever', 'soft', '--amplitude', '0.1,0.2')[1]],
                         ['0.10000000000000001', '0.20000000000000001'])

    def test_a_temperature_in_kelvin_is_warned_of(self):
        short = ['real_time', '--eta', 2, '--cutoff', 0.1, '--tau', 1, '--transient', 0, '--temperature']
        theta = BOLTZMANN * 300 / (self.K / (2 * math.pi) ** 2 * self.A ** 2)
        complaint = run(*short, 300, *self.GIVEN)[2]
        self.assertIn('warning: temperature = 300: is kT in m_tip a^2/tau^2', complaint)
        self.assertIn('%d K; for 300 K give %.3g' % (round(300 / theta * 300), theta), complaint)
        self.assertEqual(run(*short, '%.3g' % theta, *self.GIVEN)[2], '')
        self.assertEqual(run(*short, 300, '--quality-factor', 100)[2], '')

    def test_a_file_of_ones_own(self):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            def refused(text, *words):
                file.seek(0)
                file.truncate()
                file.write(text)
                file.flush()
                code, rows, complaint = run('real_time', '--eta', 2, '--tau', 1, '--lever', file.name)
                self.assertEqual(code, 2 if words else 0, complaint)
                for word in words:
                    self.assertIn(word, complaint)
            lever = 'spring_constant_n_per_m: 0.5\nresonance_hz: 2.0e+4\n'
            refused(lever + 'lateral_spring_constant_n_per_m: 60\n')
            refused(lever, 'lateral_spring_constant_n_per_m')
            refused(lever + 'lateral_spring_constant_n_per_m: high\n', file.name,
                    'lateral_spring_constant_n_per_m must')
            for number in ('013', '6e-1', '6.0e1', '"60"', '+.5'):  # which ROS takes for octal, or for text
                refused(lever + 'lateral_spring_constant_n_per_m: %s\n' % number, 'as ROS reads it')
            refused(lever + 'stiffness: 3\n', file.name, 'stiffness')
            refused(lever + 'lateral_spring_constant_n_per_m: [\n', file.name, 'line 4')
            refused(lever + 'resonance_hz: 3.0e+4\n', file.name, 'has resonance_hz twice')
            refused('', file.name, 'a key and a number')
            refused('- 0.5\n', file.name, 'a key and a number')
            by_model = ('omega_v_rad_per_s: 4.0e+4\nomega_h_rad_per_s: 2.5e+5\ntip_mass_kg: 4.0e-10\n'
                        'quality_factor: 20\n')
            refused(by_model)
            refused(by_model.replace('20', '-5'), 'lever = ' + file.name + ': quality_factor = -5')
            refused(by_model + 'kicks_per_tau: 0.0\n', 'lever = ' + file.name + ': kicks_per_tau = 0')
            refused(by_model.split('\n', 1)[1], file.name, 'lacks omega_v_rad_per_s')
            refused(by_model + 'resonance_hz: 2.0e+4\n', file.name, 'twice')
            refused(by_model + lever + 'lateral_spring_constant_n_per_m: 60\n', file.name, 'twice')

    def test_a_lever_by_its_frequencies_is_the_same_lever(self):
        omega_v = 2 * math.pi * self.F0
        text = 'omega_v_rad_per_s: %r\ntip_mass_kg: %r\nomega_h_rad_per_s: %r\nquality_factor: 100\n' % (
            omega_v, self.K / omega_v ** 2, omega_v * math.sqrt(self.K_H / self.K))
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write(text)
            file.flush()
            row, = run('real_time', '--eta', 2, '--tau', 3, '--transient', 1, '--lever', file.name, *self.GIVEN[2:])[1]
        for name, value in self.NATURAL.items():
            self.assertAlmostEqual(float(row[name.replace('-', '_')]) / value, 1, delta=1e-13, msg=name)

    def test_a_surface_of_ones_own(self):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write('lattice_spacing_m: 4.0e-10\n')
            file.flush()
            code, rows, complaint = run('friction_curve', '--si', '--eta', 2, '--surface', file.name)
            self.assertEqual((code, rows), (2, []))
            self.assertIn(file.name + ': it lacks surface_amplitude_m', complaint)

    def test_a_folder_is_no_lever(self):
        with tempfile.TemporaryDirectory(suffix='.yaml') as folder:
            code, rows, complaint = run('real_time', '--lever', folder)
            self.assertEqual((code, rows), (2, []))
            self.assertIn('lever = %s: it is a folder' % folder, complaint)


class Refused(unittest.TestCase):
    def refuse(self, words, tool, *arguments):
        code, rows, complaint = run(tool, *arguments)
        self.assertEqual((code, rows), (2, []), complaint)
        self.assertIn(words, complaint)

    def test_a_value_is_shown_as_it_was_given(self):
        curve = ['friction_curve', '--si']
        self.refuse('temperature = 300: needs a quality factor', *curve, '--temperature', 300)
        self.refuse('temperature = -1: ', *curve, '--temperature', -1, '--quality-factor', 100)
        self.refuse('drag-velocity = 1: ', *curve, '--drag-velocity', 1)
        self.refuse('where 1 is 3.64e-06 m/s', *curve, '--drag-velocity', 1, '--lever', 'soft')
        self.refuse('duration = -0.1: ', *curve, '--duration', -0.1)
        self.refuse('lattice-spacing = 0.52: ', *curve, '--lattice-spacing', 0.52)
        self.refuse('eta = 2000: ', *curve, '--eta', 2000)
        for tool in ('periodic_orbits', 'attractors'):
            self.refuse('drag-velocity = 1: ', tool, '--si', '--drag-velocity', 1)
        header = 'drag_velocity_m_per_s,gamma,cutoff_m_per_s,phase,extension_m,u_m_per_s,w_m_per_s\n'
        complaint = run('next_impact', '--si', text=header + '1e-5,0.7,-1e-7,0.1,nan,1e-5,1e-5\n')[2]
        self.assertIn('extension_m = nan: ', complaint)
        self.assertIn('cutoff_m_per_s = -1e-07: ', complaint)

    def test_what_does_not_go_together(self):
        self.refuse('drag-velocity: is taken only with --si', 'friction_curve', '--drag-velocity', 6e-6)
        self.refuse('drag-velocity: is taken in place of --eta', 'periodic_orbits', '--si', '--drag-velocity', 6e-6,
                    '--eta', 2)
        self.refuse('tip-mass: has a meaning only with --si', 'attractors', '--tip-mass', 1e-12)
        self.refuse('must be above 0', 'friction_curve', '--si', '--tip-mass', 0)
        self.refuse('must be positive, between 1e-40 and 1e40', 'next_impact', '--si', '--tip-mass', 1e50)
        self.refuse('--drag-velocity = 1e-6:2e-6:1e-6: must be a number', 'periodic_orbits', '--si', '--drag-velocity',
                    '1e-6:2e-6:1e-6')
        self.refuse('lever, surface, load: have a meaning only with --si', 'friction_curve', '--lever', 'soft')
        for scale in ('omega-v', 'tip-mass', 'lattice-spacing'):  # once only two of these were refused
            for scene in (('--lever', 'soft'), ('--surface', 'nacl'), ('--load', 1e-9)):
                self.refuse(scale + ': is that of --lever', 'friction_curve', '--si', *scene, '--' + scale, 1e-10)
        self.refuse('rest-height: is given beside --load', 'real_time', '--load', 1e-9, '--rest-height', 0)
        self.refuse('rest-height: is given beside --load', 'real_time', '--load', 0, '--rest-height', -0.5)
        self.refuse('load = nan: must be finite', 'real_time', '--load', 'nan')
        self.refuse('load = 1: ', 'real_time', '--load', 1)
        self.refuse('load = -1: ', 'friction_curve', '--si', '--load', -1)
        self.refuse('ppp_cont', 'real_time', '--lever', 'nosuch')
        self.refuse('ppp_cont', 'real_time', '--lever', '')  # it was the paper's: a variable that is not set
        self.refuse('mica', 'friction_curve', '--si', '--lever', 'soft', '--surface', '', '--eta', 1)
        self.refuse('mica', 'real_time', '--surface', 'nosuch')


if __name__ == '__main__':
    FOLDER = sys.argv.pop(1)
    unittest.main()

#!/usr/bin/python3
"""The module gives the bits of the C++ tools and examples.

Usage: bits_test.py DATA PROGRAM...     (DATA: test/data; PROGRAM: the tools and examples that it is compared with)
"""
import copy
import csv
import pickle
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

import afm

DATA = Path(sys.argv[1])
PROGRAMS = {Path(path).name: path for path in sys.argv[2:]}


def output(program, *arguments, **options):
    return subprocess.run([PROGRAMS[program], *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          check=True, timeout=150, universal_newlines=True, **options).stdout


def rows_of(text):
    return list(csv.DictReader(text.splitlines()))


class Bits(unittest.TestCase):
    def assert_same(self, table, rows, **renamed):
        """Every column of the tool, to the bit; NaN equals NaN."""
        self.assertEqual(len(table), len(rows))
        self.assertGreater(len(rows), 0)
        for name in rows[0]:
            expected = [row[name] for row in rows]
            mine = renamed[name] if name in renamed else table[name]
            if name == 'attractor':
                self.assertEqual(list(mine), expected)
            else:
                np.testing.assert_array_equal(np.array(mine, float), np.array(expected, float), name)


class Tools(Bits):
    def curve(self, *options):
        return rows_of(output('friction_curve', '--duration', '100', '--transient', '50', *options))

    def test_a_curve(self):
        mine = afm.friction_curve(np.arange(20, 40, 2) / 10, gamma=[0.5, 0.7], duration=100, transient=50, seed=7)
        self.assert_same(mine, self.curve('--eta', '2:3.8:0.2', '--gamma', '0.5:0.7:0.2', '--seed', '7'))

    def test_a_curve_whose_points_begin_where_others_end(self):
        mine = afm.friction_curve([2.0, 2.5, 3.0], sweep='down', duration=100, transient=50,
                                  model=afm.Model(cutoff=0.1))
        self.assert_same(mine, self.curve('--eta', '2:3:0.5', '--sweep', 'down', '--cutoff', '0.1'))

    def test_a_curve_with_heat_on_a_hammer(self):
        mine = afm.friction_curve([1.0, 2.0], model='hammer', temperature=0.9, quality_factor=100, duration=100,
                                  transient=50, seed=3)
        self.assert_same(mine, self.curve('--eta', '1:2:1', '--model', 'hammer', '--temperature', '0.9',
                                          '--quality-factor', '100', '--seed', '3'))

    def test_no_bit_depends_on_threads(self):
        curves = [afm.friction_curve(np.linspace(2, 4, 9), duration=50, transient=50, threads=n) for n in (1, 5)]
        np.testing.assert_array_equal(*curves)

    def test_attractors(self):
        options = dict(starts=4, transient=100, duration=100, friction_duration=50)
        mine = afm.attractors([2.0, 3.4], gamma=[0.6, 0.7], **options)
        words = [word for name, value in options.items() for word in ('--' + name.replace('_', '-'), str(value))]
        self.assert_same(mine, rows_of(output('attractors', '--eta', '2:3.4:1.4', '--gamma', '0.6:0.7:0.1', *words)))

    def test_periodic_orbits(self):
        mine = afm.periodic_orbits(2.5, max_length=2, trajectory=2000, guesses=50)
        columns = {'multiplier_%d_%s' % (i + 1, part): getattr(mine['multipliers'][:, i], name)
                   for i in range(4) for part, name in (('re', 'real'), ('im', 'imag'))}
        words = ['--eta', '2.5', '--max-length', '2', '--trajectory', '2000', '--guesses', '50', '--quiet']
        self.assert_same(mine, rows_of(output('periodic_orbits', *words)), **columns)

    def test_another_lever(self):
        other = dict(frequency_ratio=21.0, amplitude=0.125, rest_height=-0.05)
        words = [word for name, value in other.items() for word in ('--' + name.replace('_', '-'), str(value))]
        state = dict(eta=3.4, gamma=0.7, cutoff=0.05, phase=0.25, extension=0.01, u=3.4, w=2.0)
        text = ','.join(state) + '\n' + ','.join(map(str, state.values())) + '\n'
        impact = afm.next_impact(**state, model=afm.Model(**other))
        self.assert_same(impact[None], rows_of(output('next_impact', *words, input=text)))
        short = dict(starts=4, transient=50, duration=50, friction_duration=50)
        words += [word for name, value in short.items() for word in ('--' + name.replace('_', '-'), str(value))]
        self.assert_same(afm.attractors(2.0, **other, **short), rows_of(output('attractors', '--eta', '2', *words)))

    def test_next_impact(self):
        with open(str(DATA / 'next_impact.csv')) as file:
            lines = [','.join(line.split(',')[:7]) for line in file.read().splitlines()]
        rows = rows_of(output('next_impact', input='\n'.join(lines) + '\n'))
        inputs = {name: np.array([float(row[name]) for row in rows]) for name in lines[0].split(',')}
        self.assert_same(afm.next_impact(**inputs), rows)


class Examples(Bits):
    def test_impacts_of_a_tip(self):
        units = afm.Units()
        eta = 10e-6 / units.velocity
        impacts = afm.Tip(units.model, eta).advance(10e-3 / units.time)
        columns = {'time_s': (impacts['tau'] + impacts['phase']) * units.time,
                   'normal_speed_m_per_s': impacts['normal_speed'] * units.velocity,
                   'tangential_velocity_m_per_s': impacts['tangential_velocity'] * units.velocity,
                   'energy_loss_j': impacts['energy_loss'] * units.energy}
        self.assert_same(impacts, rows_of(output('afm_example_impacts_to_csv')), **columns)

    def test_friction_of_a_warm_scene(self):
        units = afm.Units(rest_height_m=-0.02e-9, restitution_gamma=0.8)
        run = afm.Run(units.model, 6.6e-6 / units.velocity, bath=units.bath(temperature_k=300, quality_factor=100))
        lines = []
        for i in range(100):
            f = run.advance().friction
            if i % 10 == 9:
                lines.append('%6.0f tau: force %.6g N, K_f %.6g +- %.6g kg/s' % (
                    run.now, f['mean_lateral_force'] * units.force, f['k_f_work'] * units.friction,
                    f['k_f_work_std_error'] * units.friction))
        self.assertEqual(lines, output('afm_example_warm_scene').splitlines())


class Within(Bits):
    """The same motion by other calls."""

    def test_samples_and_events_of_tip_and_run(self):
        tip, batched = afm.Tip(eta=3.1), afm.Run(eta=3.1, sample_period=0.07)
        mine, run = tip.samples(0.07, 10000), batched.advance(700.0)
        count = len(run.vertical)
        self.assertGreaterEqual(count, 9999)
        np.testing.assert_array_equal(mine.vertical[:count], run.vertical[:10000])
        np.testing.assert_array_equal(mine.lateral[:count], run.lateral[:10000])
        shared = min(len(mine.events), len(run.impacts))
        self.assertGreater(shared, 1000)
        np.testing.assert_array_equal(mine.events[:shared], run.impacts[:shared])

    def test_a_run_goes_on_as_one_made_from_its_snapshot(self):
        run = afm.Run(afm.Model(cutoff=0.005), eta=0.05, bath=afm.Bath(0, 1e6), samples_per_batch=100)
        phases = set()
        for i in range(300):
            run.apply(eta=0.05 + 0.001 * (i % 20), friction_window=100.0 + i)
            run.advance(run.now.after(0.123))
            snapshot = run.snapshot()
            phases.add(snapshot['phase'])
            for other in (afm.Run.from_snapshot(snapshot), pickle.loads(pickle.dumps(afm.Run.from_snapshot(snapshot))),
                          copy.copy(run), run.copy()):
                again, mine = other.advance(), run.copy().advance()
                self.assertEqual((again.begin, again.end, again.holder), (mine.begin, mine.end, mine.holder))
                for name in ('vertical', 'lateral', 'impacts'):
                    np.testing.assert_array_equal(getattr(again, name), getattr(mine, name))
                for name, figure in mine.friction.items():
                    np.testing.assert_array_equal(again.friction[name], figure, name)
        self.assertTrue(phases >= {0, 1, 2}, phases)

    def test_to_a_time_and_by_batches_is_one_run(self):
        whole, parts = afm.Run(), afm.Run()
        long = whole.advance(100.0)
        batches = []
        while parts.now < (100, 0.0):
            batches.append(parts.advance(100.0, impacts=7))
            self.assertLessEqual(len(batches[-1].impacts), 7)
        for name in ('vertical', 'lateral', 'impacts'):
            np.testing.assert_array_equal(getattr(long, name), np.concatenate([getattr(b, name) for b in batches]))
        self.assertEqual(long.friction['energy_loss'], batches[-1].friction['energy_loss'])

    def test_a_flight_of_a_tip_is_that_of_next_impact(self):
        tip = afm.Tip(contact_tolerance=0)
        event, = tip.advance(100, most_events=1)
        start, before = tip.state, tip.now
        following, = tip.advance(100, most_events=1)
        flight = afm.next_impact(eta=3.4, phase=start.phase, extension=start.extension, u=start.u, w=start.w)
        self.assertAlmostEqual(float(flight['dt']), float(tip.now) - float(before), delta=1e-13)
        self.assertAlmostEqual(float(flight['energy_loss']), following['energy_loss'], delta=1e-12)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/env python3
"""The tool friction_curve: the same bytes however it is run, whatever stops it, and refusals of every bad input.

Usage: friction_curve_test.py TOOL
"""
import csv
import fcntl
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'support'))
from terminal import run_on_a_terminal  # noqa: E402

TOOL = None
HEADER = ('eta,gamma,cutoff,k_f,k_f_std_error,impacts_per_tau,mean_energy_loss,mean_flight_time,largest_lyapunov,'
          'attractor,rest_height,amplitude,frequency_ratio,k_f_work,k_f_work_std_error')
MAP = ['--eta', '1.5:5:0.5', '--gamma', '0.6:0.7:0.1', '--cutoff', '0.1:0.2:0.1', '--duration', '300',
       '--transient', '100']
HYSTERESIS = '2.3:2.7:0.02'  # two attractors near 2.5
DEADLINE = 60.0


class Case(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.directory = Path(holder.name)

    def run_tool(self, arguments, name=None):
        output = ['--output', str(self.directory / name)] if name else []
        return subprocess.run([TOOL, *arguments, *output], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=DEADLINE)

    def table(self, arguments, name):
        done = self.run_tool(arguments, name)
        self.assertEqual((done.returncode, done.stderr), (0, b''))
        return (self.directory / name).read_bytes()

    def rows(self, arguments, name='rows.csv'):
        return list(csv.DictReader(self.table(arguments, name).decode().splitlines()))


class SameBytes(Case):
    def test_any_number_of_threads_and_standard_output(self):
        one = self.table([*MAP, '--threads', '1'], 'one.csv')
        self.assertEqual(one.decode().splitlines()[0], HEADER)
        self.assertEqual(len(one.splitlines()), 1 + 8 * 2 * 2)
        self.assertEqual(self.table([*MAP, '--threads', '2'], 'two.csv'), one)
        self.assertEqual(self.run_tool(MAP).stdout, one)
        (self.directory / '-').write_text('no table')  # it was taken for the output
        done = subprocess.run([os.path.abspath(TOOL), *MAP], cwd=str(self.directory), stdout=subprocess.PIPE)
        self.assertEqual(done.stdout, one)

    def interrupted(self, arguments, number):
        """Stopped with some rows there and some not, then finished."""
        stopped = self.directory / 'stopped.csv'

        def lines():
            return stopped.read_bytes().count(b'\n') if stopped.exists() else 0
        process = subprocess.Popen([TOOL, *arguments, '--output', str(stopped)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        deadline = time.monotonic() + DEADLINE
        while lines() < 4 and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.001)
        process.send_signal(number)
        reported = process.communicate(timeout=DEADLINE)[1]
        self.assertTrue(4 <= lines() < 120, 'it was finished before it was stopped')
        return process.returncode, reported, self.table(arguments, 'stopped.csv')

    def test_interrupted(self):
        for sweep in ('fresh', 'up'):
            long = ['--eta', '3:6:0.15', '--gamma', '0.6:0.7:0.02', '--cutoff', '0.3', '--duration', '2000', '--sweep',
                    sweep]
            whole = self.table(long, 'whole.csv')
            code, reported, finished = self.interrupted(long, signal.SIGINT)
            self.assertEqual(finished, whole)
            self.assertEqual(code, 130)
            self.assertIn(b'the same command goes on from ' + (b'there' if sweep == 'fresh' else b'the last'), reported)
            (self.directory / 'stopped.csv').unlink()
            code, _, finished = self.interrupted([*long, '--threads', '1'], signal.SIGKILL)
            self.assertEqual((code, finished), (-signal.SIGKILL, whole))
            for name in ('whole.csv', 'stopped.csv'):
                (self.directory / name).unlink()

    def test_a_line_cut_short(self):
        for sweep in ('fresh', 'up'):
            whole = self.table([*MAP, '--sweep', sweep], 'cut.csv')
            for size in (0, 150, 400, 2500):
                os.truncate(str(self.directory / 'cut.csv'), size)
                self.assertEqual(self.table([*MAP, '--sweep', sweep], 'cut.csv'), whole)
            (self.directory / 'cut.csv').unlink()

    def test_one_run_at_a_time(self):
        self.table(MAP, 'held.csv')
        with (self.directory / 'held.csv.settings').open() as settings:
            fcntl.flock(settings, fcntl.LOCK_EX)
            done = self.run_tool(MAP, 'held.csv')
        self.assertEqual(done.returncode, 2)
        self.assertIn(b'used by another run', done.stderr)


class Refusals(Case):
    def assert_refused(self, arguments, *words):
        done = self.run_tool(arguments)
        self.assertEqual((done.returncode, done.stdout), (2, b''), arguments)
        for word in words:
            self.assertIn(word, done.stderr.decode())

    def test_bad_input(self):
        self.assert_refused(['--eta', '1:2:-1'], 'eta = 1:2:-1', 'STEP must be above 0')
        self.assert_refused(['--eta', '1:2000:1'], 'eta = 1001', 'at most 1000')
        self.assert_refused(['--gamma', '0.5:1.5:0.5', '--duration', '0'], 'gamma = 1.5', 'duration = 0')
        self.assert_refused(['--cutoff', 'nan'], 'cutoff = nan', 'not a number')
        self.assert_refused(['--cutoff', '-1'], 'cutoff = -1')
        self.assert_refused(['--transient', '-1'], 'transient = -1')
        self.assert_refused(['--frequency-ratio', '-1'], 'frequency-ratio = -1')
        self.assert_refused(['--duration', 'x'], 'duration', 'x')
        self.assert_refused(['--threads', '-1'], 'threads = -1')
        self.assert_refused(['--seed', '-1'], 'seed = -1')
        self.assert_refused(['--sweep', 'sideways'], 'sweep = sideways')
        self.assert_refused(['--model', 'anvil'], 'model = anvil')
        self.assert_refused(['--output', '/no/such/place.csv'], '/no/such/place.csv', 'No such file')
        self.assert_refused(['stray'], 'stray')

    def test_kicks_that_lock_are_warned_of_once(self):
        heat = ['--temperature', '1', '--quality-factor', '20', '--duration', '20', '--transient', '1']
        done = self.run_tool(['--eta', '1:3:1', '--frequency-ratio', '6:14:8', *heat])
        self.assertEqual((done.returncode, len(done.stdout.splitlines())), (0, 7))
        self.assertEqual(done.stderr.count(b'\n'), 1, done.stderr)
        for word in (b'warning: kicks-per-tau = 29.034', b'omega_h/omega_v = 14', b'give 46.979'):
            self.assertIn(word, done.stderr)
        silent = self.run_tool(['--eta', '2', '--frequency-ratio', '14', '--kicks-per-tau', '46.979', *heat])
        self.assertEqual(silent.stderr, b'')

    def test_kicks_that_lock_to_one_of_the_drags_are_warned_of_once(self):
        heat = ['--temperature', '1', '--quality-factor', '100', '--kicks-per-tau', '10', '--duration', '20',
                '--transient', '1']
        self.assertEqual(self.run_tool(['--eta', '2:4:0.1', *heat]).stderr, b'')
        done = self.run_tool(['--eta', '9.99:10.01:0.005', *heat])
        self.assertEqual((done.returncode, done.stderr.count(b'\n')), (0, 1), done.stderr)
        for word in (b'warning: kicks-per-tau = 10: locks to the drag near eta = 10, ', b'give 11.09'):
            self.assertIn(word, done.stderr)

    def test_a_drag_over_less_than_the_surface_is_warned_of(self):
        """K_f was many standard errors off, with the sign of the slope below the tip."""
        bath = ['--temperature', '0.926', '--quality-factor', '100', '--rest-height', '-0.3', '--duration', '100']
        done = self.run_tool(['--eta', '1e-5', *bath])
        self.assertIn(b'duration = 100: at eta = 1e-05 the holder passes only 0.001 lattice spacings', done.stderr)
        self.assertEqual(self.run_tool(['--eta', '0.2', *bath]).stderr, b'')

    def test_other_settings(self):
        table, curve = self.table(MAP, 'curve.csv'), self.directory / 'curve.csv'
        self.assertEqual(self.table(MAP, 'curve.csv'), table)
        self.assertEqual(self.run_tool([*MAP[2:], '--eta', '1.5:5.5:0.5'], 'curve.csv').returncode, 2)
        heat = ['--quality-factor', '50']
        for extra in (['--seed', '2'], ['--sweep', 'up'], ['--si'], ['--model', 'hammer'], heat,
                      ['--temperature', '0.1', *heat], ['--kicks-per-tau', '20', *heat]):
            done = self.run_tool([*MAP, *extra], 'curve.csv')
            self.assertEqual(done.returncode, 2)
            self.assertIn(b'other settings', done.stderr)
            self.assertEqual(curve.read_bytes(), table)
        curve.unlink()
        self.assertNotEqual(self.table([*MAP, '--seed', '2'], 'curve.csv'), table)

    def test_a_damaged_table(self):
        """Once a lost row was made up for at the end."""
        lines = self.table(MAP, 'curve.csv').splitlines(True)
        curve = self.directory / 'curve.csv'
        for damaged in (lines[:3] + lines[4:], lines[:3] + [b'junk\n'] + lines[4:], lines + lines[-1:]):
            curve.write_bytes(b''.join(damaged))
            done = self.run_tool(MAP, 'curve.csv')
            self.assertEqual((done.returncode, curve.read_bytes()), (2, b''.join(damaged)), done.stderr)

    def test_a_file_of_someone_else(self):
        notes = self.directory / 'notes.csv'
        notes.write_text('mine\n')
        self.assertEqual(self.run_tool(MAP, 'notes.csv').returncode, 2)
        self.assertEqual(notes.read_text(), 'mine\n')

    def test_a_full_disk(self):
        with open('/dev/full', 'w') as full:
            done = subprocess.run([TOOL, *MAP], stdout=full, stderr=subprocess.PIPE, timeout=DEADLINE)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b'cannot write the standard output', done.stderr)
        self.assertNotIn(b'choose another name', done.stderr)


class Physics(Case):
    def test_friction_depends_on_history_where_attractors_coexist(self):
        # seed: of a start that leads to the other attractor than the one carried down
        curve = ['--cutoff', '0.2', '--eta', HYSTERESIS, '--duration', '500', '--seed', '1']
        up = self.rows([*curve, '--sweep', 'up'], 'up.csv')
        down = self.rows([*curve, '--sweep', 'down'], 'down.csv')
        self.assertEqual([row['eta'] for row in up], [row['eta'] for row in reversed(down)])
        apart = [abs(float(a['k_f']) - float(b['k_f'])) for a, b in zip(up, reversed(down))]
        errors = [float(a['k_f_std_error']) + float(b['k_f_std_error']) for a, b in zip(up, reversed(down))]
        self.assertTrue(any(d > 0.03 + 5 * e for d, e in zip(apart, errors)), apart)
        self.assertTrue(any(d < 1e-9 for d in apart), apart)

    def test_the_columns(self):
        row = self.rows(['--eta', '2', '--cutoff', '0.2', '--sweep', 'up', '--duration', '200'])[0]
        self.assertEqual(','.join(row), HEADER)
        self.assertTrue(row['attractor'].startswith('period-'))
        rate, flight = float(row['impacts_per_tau']), float(row['mean_flight_time'])
        self.assertAlmostEqual(rate * flight, 1.0)
        self.assertAlmostEqual(rate * float(row['mean_energy_loss']) / 4.0, float(row['k_f']))
        self.assertLess(float(row['largest_lyapunov']), 0.0)

    def test_progress_is_shown_on_a_terminal(self):
        code, shown = run_on_a_terminal([TOOL, *MAP])
        self.assertEqual(code, 0)
        self.assertIn('32/32 points', shown)


if __name__ == '__main__':
    TOOL = sys.argv[1]
    unittest.main(argv=sys.argv[:1])

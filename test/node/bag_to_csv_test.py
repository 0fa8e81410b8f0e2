#!/usr/bin/python3
"""bag_to_csv writes every number of a recording as rosbag's reader finds it, in SI to the bit and in natural units to
rounding; what is missing it names, and writes what there is."""
import csv
import subprocess
from pathlib import Path

import roslib.packages
from afm_emulator.msg import Friction

import bags
from checks import UNCHECKED, USAGE
from emulator_under_test import ENERGY_UNIT, FRICTION_UNIT, PACKAGE, SPEED_UNIT, TAU_S, Emulator, NodeTest, run
from spoiled_bag import SpoiledBag
from topics import PATIENCE, Topic

LENGTH_UNIT = 0.52e-9
IMPACT = {'surface_phase': ('surface_phase', 1), 'normal_speed': ('normal_speed_m_per_s', SPEED_UNIT),
          'tangential_velocity': ('tangential_velocity_m_per_s', SPEED_UNIT),
          'energy_loss': ('energy_loss_j', ENERGY_UNIT), 'kind': ('kind', 1), 'count': ('count', 1)}
FRICTION_SUFFIX = {'eta': '', 'impact_count': '', 'drag_velocity': '_m_per_s', 'energy_loss': '_j',
                   'heat_to_bath': '_j', 'force': '_n', 'force_std_error': '_n', 'window_force': '_n',
                   'mean_lateral_force': '_n',
                   'mean_lateral_force_std_error': '_n', 'mean_normal_force': '_n'}  # all others: _kg_per_s
NOT_IN_TABLE = ('header', 'epoch', 'begin', 'time', 'first_impact', 'impact_limit', 'k_f_natural', 'window_k_f_natural',
                'k_f_work_natural')
APPLIED = {'drag_velocity_m_per_s': 'drag_velocity', 'restitution_gamma': 'restitution_gamma',
           'cutoff_speed_m_per_s': 'cutoff_speed', 'rest_height_m': 'rest_height_m',
           'sample_rate_per_s': 'sample_rate_hz', 'friction_window_tau': 'friction_window_tau',
           'temperature_k': 'temperature_k', 'quality_factor': 'quality_factor',
           'lateral_quality_factor': 'lateral_quality_factor', 'kicks_per_tau': 'kicks_per_tau',
           'contact_tolerance': 'contact_tolerance', 'first_impact': 'first_impact', 'number': 'number', 'tau': None,
           'phase': None}


def call(*arguments):
    binary = roslib.packages.find_node(PACKAGE, 'bag_to_csv')[0]
    done = subprocess.run([binary] + [str(argument) for argument in arguments],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          timeout=60 * PATIENCE)
    return done.returncode, list(csv.DictReader(done.stdout.splitlines())), done.stderr


def table(paths, *options):
    code, rows, complaint = call(*paths, *options)
    assert (code, complaint) == (0, ''), complaint
    return rows


def same(text, value):
    """The same double; NaN is itself."""
    return float(text) == value or (float(text) != float(text) and value != value)


class BagToCsv(NodeTest):
    @staticmethod
    def merged(paths, topic):
        found = {message.header.seq: message for path in paths for message in bags.read(path)[topic]}
        return [found[seq] for seq in sorted(found)]

    def test_a_split_recording_topic_by_topic(self):
        directory = Path(self.temporary_directory())
        emulator = self.start(Emulator(dict(record=True, bag_directory=str(directory), sample_rate_hz=20000.0,
                                            temperature_k=300.0, quality_factor=100.0, split_duration_s=0.4)))
        applied, friction = Topic('applied'), Topic('friction')
        friction.wait_for()
        emulator.drag(2 * SPEED_UNIT)
        applied.wait_for(lambda m: m.drag_velocity == 2 * SPEED_UNIT)
        emulator.publisher('rest_height').publish(-1e-11)
        applied.wait_for(lambda m: m.rest_height_m == -1e-11)
        friction.wait_for_more(60)
        self.assertEqual(emulator.stop(), 0)
        paths = sorted(str(path) for path in directory.iterdir())
        self.assertGreater(len(paths), 1)
        self.check_impacts(paths)
        self.check_deflection(paths)
        self.check_friction(paths)
        self.check_commands(paths)
        code, rows, complaint = call(*paths[::-1], '--topic', 'friction')
        self.assertEqual((code, rows), (USAGE, []))
        self.assertIn('does not go on where', complaint)

    def check_impacts(self, paths):
        found = [(batch, batch.first_index + i, impact) for batch in self.merged(paths, 'impacts')
                 for i, impact in enumerate(batch.impacts)]
        rows, natural = (table(paths, '--topic', 'impacts', *more) for more in ((), ('--natural',)))
        self.assertGreater(len(rows), 1000)
        self.assertEqual((len(rows), len(natural)), (len(found), len(found)))
        for row, other, (batch, index, impact) in zip(rows, natural, found):
            self.assertEqual((int(row['epoch']), int(row['index']), int(row['tau']), float(row['phase'])),
                             (batch.epoch, index, impact.time.tau, impact.time.phase))
            self.assertAlmostEqual(float(row['time_s']) / TAU_S, impact.time.tau + impact.time.phase, delta=1e-9)
            for field, (column, unit) in IMPACT.items():
                value = getattr(impact, field)
                self.assertTrue(same(row[column], value), (column, row, impact))
                self.assertAlmostEqual(float(other[self.natural_name(column)]), value / unit,
                                       delta=1e-14 * abs(value / unit))

    def natural_name(self, column):
        for si, natural in (('_m_per_s', '_a_per_tau'), ('_j', '_m_tip_a2_per_tau2'), ('_m', '_a')):
            if column.endswith(si):
                return column[:-len(si)] + natural
        return column

    def check_deflection(self, paths):
        rows, natural = (table(paths, '--topic', 'deflection', *more) for more in ((), ('--natural',)))
        found = [(b.first_sample + i, (b.time.tau + b.time.phase) * TAU_S + i * b.sample_period, v, w)
                 for b in self.merged(paths, 'deflection') for i, (v, w) in enumerate(zip(b.vertical, b.lateral))]
        self.assertEqual(len(rows), len(found))
        for row, other, (index, time, vertical, lateral) in zip(rows, natural, found):
            self.assertEqual((int(row['index']), float(row['vertical_m']), float(row['lateral_m'])),
                             (index, vertical, lateral))
            self.assertAlmostEqual(float(row['time_s']), time, delta=1e-12)
            self.assertAlmostEqual(float(other['vertical_a']), vertical / LENGTH_UNIT, delta=1e-15)
            self.assertAlmostEqual(float(other['time_tau']), time / TAU_S, delta=1e-8)

    def check_friction(self, paths):
        found = self.merged(paths, 'friction')
        rows, natural = (table(paths, '--topic', 'friction', *more) for more in ((), ('--natural',)))
        self.assertEqual(len(rows), len(found))
        for row, other, message in zip(rows, natural, found):
            self.assertEqual((int(row['tau']), float(row['phase'])), (message.time.tau, message.time.phase))
            for field in Friction.__slots__:  # a field that the table lacks is a KeyError
                if field not in NOT_IN_TABLE:
                    column = field + FRICTION_SUFFIX.get(field, '_kg_per_s')
                    self.assertTrue(same(row[column], getattr(message, field)), (column, row, message))
            if message.k_f == message.k_f:
                self.assertAlmostEqual(float(other['k_f_m_tip_per_tau']), message.k_f_natural,
                                       delta=1e-13 * abs(message.k_f_natural))
                self.assertAlmostEqual(float(other['k_f_m_tip_per_tau']) * FRICTION_UNIT, float(row['k_f_kg_per_s']),
                                       delta=1e-16)

    def check_commands(self, paths):
        rows, found = table(paths, '--topic', 'commands'), self.merged(paths, 'applied')
        self.assertEqual(len(found), 3)
        self.assertEqual(len(rows), len(found))
        for row, message in zip(rows, found):
            for column, field in APPLIED.items():
                value = getattr(message, field) if field else getattr(message.time, column)
                self.assertEqual(float(row[column]), value, column)
            self.assertEqual((row['model'], row['cause']), (message.model, message.cause))
        self.assertAlmostEqual(float(table(paths, '--topic', 'commands', '--natural')[-1]['drag_velocity_a_per_tau']),
                               2, delta=1e-14)


class Incomplete(SpoiledBag):
    def test_one_message_of_impacts_is_lost(self):
        lost = self.of('impacts')[60].message()
        self.remove(self.of('impacts')[60])
        path = self.write()
        code, rows, complaint = call(path, '--topic', 'impacts')
        self.assertEqual((code, complaint), (UNCHECKED, 'bag_to_csv: warning: 1 messages of impacts are missing\n'))
        indices = [int(row['index']) for row in rows]
        gap = set(range(lost.first_index, lost.first_index + len(lost.impacts)))
        self.assertEqual(indices, [i for i in range(indices[-1] + 1) if i not in gap])
        for topic in ('deflection', 'friction', 'commands'):  # of which nothing is missing
            self.assertTrue(table([path], '--topic', topic))

    def test_a_bag_without_a_topic(self):
        self.remove(*self.of('deflection'), *self.of('snapshot'))
        path = self.write()
        for topic in ('impacts', 'friction', 'commands'):
            self.assertTrue(table([path], '--topic', topic))
        code, rows, complaint = call(path, '--topic', 'deflection')
        self.assertEqual((code, rows), (UNCHECKED, []))
        self.assertIn('holds no messages of this topic', complaint)

    def test_refuses_by_name(self):
        for arguments, code, words in (((self.good,), USAGE, 'topic: must be given'),
                                       (('--topic', 'impacts'), USAGE, 'bags: must be given'),
                                       ((self.good, '--topic', 'samples'), USAGE,
                                        'topic = samples: must be impacts, deflection'),
                                       ((self.good, '--topic', 'impacts', '--node', '/other'), UNCHECKED, '/other'),
                                       (('/no/such.bag', '--topic', 'impacts'), UNCHECKED, '/no/such.bag'),
                                       ((self.good, self.good, '--topic', 'impacts'), USAGE, 'does not go on where')):
            answer = call(*arguments)
            self.assertEqual((answer[0], answer[1]), (code, []), answer)
            self.assertIn(words, answer[2])


if __name__ == '__main__':
    run(BagToCsv, Incomplete)

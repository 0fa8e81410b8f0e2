#!/usr/bin/python3
"""bag_to_csv writes every number of a recording as rosbag's reader finds it, in SI to the bit and in natural units to rounding."""
import csv
import subprocess
from pathlib import Path

import roslib.packages
import rospy
from afm_emulator.msg import Friction
from std_msgs.msg import Float64

import bags
from checks import FOREIGN, MISSING, REORDERED, USAGE
from emulator_under_test import ENERGY_UNIT, FRICTION_UNIT, PACKAGE, SPEED_UNIT, TAU_S, Emulator, NodeTest, run
from topics import NAMESPACE, PATIENCE, Topic, wait_until

LENGTH_UNIT = 0.52e-9
IMPACT = {'surface_phase': ('surface_phase', 1), 'normal_speed': ('normal_speed_m_per_s', SPEED_UNIT),
          'tangential_velocity': ('tangential_velocity_m_per_s', SPEED_UNIT), 'energy_loss': ('energy_loss_j', ENERGY_UNIT),
          'kind': ('kind', 1), 'count': ('count', 1)}
FRICTION_SUFFIX = {'eta': '', 'impact_count': '', 'drag_velocity': '_m_per_s', 'energy_loss': '_j', 'heat_to_bath': '_j',
                   'force': '_n', 'force_std_error': '_n', 'window_force': '_n', 'mean_lateral_force': '_n',
                   'mean_lateral_force_std_error': '_n'}  # all others: _kg_per_s

LIVE = {'restitution_gamma': 'restitution_gamma', 'cutoff_speed_m_per_s': 'cutoff_speed', 'rest_height_m': 'rest_height_m',
        'sample_rate_per_s': 'sample_rate_hz', 'friction_window_tau': 'friction_window_tau', 'temperature_k': 'temperature_k',
        'quality_factor': 'quality_factor', 'lateral_quality_factor': 'lateral_quality_factor', 'kicks_per_tau': 'kicks_per_tau'}


def call(*arguments):
    binary = roslib.packages.find_node(PACKAGE, 'bag_to_csv')[0]
    done = subprocess.run([binary] + [str(argument) for argument in arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=60 * PATIENCE)
    return done.returncode, list(csv.DictReader(done.stdout.splitlines())), done.stderr


def merged(paths, topic):
    return [message for path in paths for message in bags.read(path)[topic]]


def same(text, value):
    """The same double; NaN is itself."""
    return float(text) == value or (float(text) != float(text) and value != value)


class BagToCsv(NodeTest):
    def setUp(self):
        super().setUp()
        self.directory = Path(self.temporary_directory())

    def record(self, **parameters):
        """Commands in two epochs' worth of batches; the parts of the recording."""
        emulator = self.start(Emulator(dict(record=True, bag_directory=str(self.directory), sample_rate_hz=20000.0,
                                            temperature_k=300.0, quality_factor=100.0, **parameters)))
        applied, changed, friction = Topic('applied_drag'), Topic('applied_parameters'), Topic('friction')
        rest_height = rospy.Publisher(NAMESPACE + '/rest_height', Float64, queue_size=10)
        friction.wait_for()
        emulator.drag(2 * SPEED_UNIT)
        applied.wait_for(lambda m: m.drag_velocity == 2 * SPEED_UNIT)
        wait_until(lambda: rest_height.get_num_connections() > 0, 'the emulator listens to rest_height')
        rest_height.publish(-1e-11)
        changed.wait_for(lambda m: m.rest_height_m == -1e-11)
        emulator.drag(-3 * SPEED_UNIT)
        applied.wait_for(lambda m: m.drag_velocity == -3 * SPEED_UNIT)
        friction.wait_for_more(60)
        self.assertEqual(emulator.stop(), 0)
        return sorted(str(path) for path in self.directory.iterdir())

    def table(self, paths, *options):
        code, rows, complaint = call(*paths, *options)
        self.assertEqual((code, complaint), (0, ''))
        return rows

    def test_a_split_recording_topic_by_topic(self):
        paths = self.record(split_duration_s=0.4)
        self.assertGreater(len(paths), 1)
        self.check_impacts(paths)
        self.check_deflection(paths)
        self.check_friction(paths)
        self.check_commands(paths)
        # parts: all of them in order, or the first of them
        # the last part is not continued and the first continues none, so each is another recording; two between them are not
        self.assertEqual(call(*paths[::-1], '--topic', 'friction')[0], REORDERED if len(paths) > 3 else USAGE)
        if len(paths) > 2:
            self.assertEqual(call(paths[0], paths[2], '--topic', 'friction')[0], MISSING)

    def check_impacts(self, paths):
        found = [(batch, batch.first_index + i, impact) for batch in merged(paths, 'impacts')
                 for i, impact in enumerate(batch.impacts)]
        rows, natural = (self.table(paths, '--topic', 'impacts', *more) for more in ((), ('--natural',)))
        self.assertGreater(len(rows), 1000)
        self.assertEqual((len(rows), len(natural)), (len(found), len(found)))
        for row, other, (batch, index, impact) in zip(rows, natural, found):
            self.assertEqual((int(row['epoch']), int(row['index']), int(row['tau']), float(row['phase'])),
                             (batch.epoch, index, impact.time.tau, impact.time.phase))
            self.assertAlmostEqual(float(row['time_s']) / TAU_S, impact.time.tau + impact.time.phase, delta=1e-9)
            for field, (column, unit) in IMPACT.items():
                value = getattr(impact, field)
                self.assertTrue(same(row[column], value), (column, row, impact))
                self.assertAlmostEqual(float(other[self.natural_name(column)]), value / unit, delta=1e-14 * abs(value / unit))

    def natural_name(self, column):
        for si, natural in (('_m_per_s', '_a_per_tau'), ('_j', '_m_tip_a2_per_tau2'), ('_m', '_a')):
            if column.endswith(si):
                return column[:-len(si)] + natural
        return column

    def check_deflection(self, paths):
        batches = merged(paths, 'deflection')
        rows, natural = (self.table(paths, '--topic', 'deflection', *more) for more in ((), ('--natural',)))
        found = [(b.first_sample + i, (b.time.tau + b.time.phase) * TAU_S + i * b.sample_period, v, w) for b in batches
                 for i, (v, w) in enumerate(zip(b.vertical, b.lateral))]
        self.assertEqual(len(rows), len(found))
        for row, other, (index, time, vertical, lateral) in zip(rows, natural, found):
            self.assertEqual((int(row['index']), float(row['vertical_m']), float(row['lateral_m'])), (index, vertical, lateral))
            self.assertAlmostEqual(float(row['time_s']), time, delta=1e-12)
            self.assertAlmostEqual(float(other['vertical_a']), vertical / LENGTH_UNIT, delta=1e-15)
            self.assertAlmostEqual(float(other['time_tau']), time / TAU_S, delta=1e-8)

    def check_friction(self, paths):
        found = merged(paths, 'friction')
        rows, natural = (self.table(paths, '--topic', 'friction', *more) for more in ((), ('--natural',)))
        self.assertEqual(len(rows), len(found))
        for row, other, message in zip(rows, natural, found):
            self.assertEqual((int(row['tau']), float(row['phase'])), (message.time.tau, message.time.phase))
            for field in Friction.__slots__:  # a field that the table lacks is a KeyError
                if field not in ('header', 'epoch', 'time', 'k_f_natural'):
                    column = field + FRICTION_SUFFIX.get(field, '_kg_per_s')
                    self.assertTrue(same(row[column], getattr(message, field)), (column, row, message))
            if message.k_f == message.k_f:
                self.assertAlmostEqual(float(other['k_f_m_tip_per_tau']), message.k_f_natural,
                                       delta=1e-13 * abs(message.k_f_natural))
                self.assertAlmostEqual(float(other['k_f_m_tip_per_tau']) * FRICTION_UNIT, float(row['k_f_kg_per_s']), delta=1e-16)

    def check_commands(self, paths):
        rows = self.table(paths, '--topic', 'commands')
        reported = sorted((m.time.tau, m.time.phase) for topic in ('applied_drag', 'applied_parameters') for m in merged(paths, topic))
        self.assertEqual(sorted({(int(r['tau']), float(r['phase'])) for r in rows}), sorted(set(reported)))
        first, last = rows[0], rows[-1]
        start = merged(paths, 'configuration')[0]
        self.assertEqual((float(first['time_s']), float(first['drag_velocity_m_per_s'])), (0.0, start.drag_velocity))
        self.assertEqual((float(last['drag_velocity_m_per_s']), float(last['rest_height_m'])), (-3 * SPEED_UNIT, -1e-11))
        change = merged(paths, 'applied_parameters')[-1]
        for column, field in LIVE.items():
            self.assertEqual(float(last[column]), getattr(change, field), column)
        self.assertAlmostEqual(float(self.table(paths, '--topic', 'commands', '--natural')[-1]['drag_velocity_a_per_tau']), -3,
                               delta=1e-14)

    def test_refuses_by_name(self):
        paths = self.record()
        for arguments, code, words in (((paths[0],), USAGE, 'topic: must be given'),
                                       (('--topic', 'impacts'), USAGE, 'bags: must be given'),
                                       ((paths[0], '--topic', 'samples'), USAGE, 'topic = samples: must be impacts, deflection'),
                                       ((paths[0], '--topic', 'impacts', '--node', '/other'), FOREIGN, '/other'),
                                       (('/no/such.bag', '--topic', 'impacts'), FOREIGN, 'cannot be opened'),
                                       ((__file__, '--topic', 'impacts'), FOREIGN, 'is not a ROS bag'),
                                       ((paths[0], paths[0], '--topic', 'impacts'), USAGE, 'does not go on where')):
            answer = call(*arguments)
            self.assertEqual((answer[0], answer[1]), (code, []), answer)
            self.assertIn(words, answer[2])


if __name__ == '__main__':
    run(BagToCsv)

"""bag_to_csv writes every number of a recording as rosbag's reader finds it, in SI to the bit and in natural units to
rounding; what is missing it names, and writes what there is."""
import genpy
from afm_emulator.msg import Friction

import bags
from checks import SOUND, UNCHECKED, USAGE
from emulator_under_test import SPEED_UNIT, TAU_S, NodeTest, find
from spoiled_bag import SpoiledBag
from tables import run_tool
from topics import Topic

UNITS = ('_m_per_s', '_kg_per_s', '_per_s', '_j', '_n', '_m', '_s')  # in the names of columns
OTHER_NAMES = {'sample_rate': 'sample_rate_hz'}
NAMES = {
    'impacts': 'epoch,tau,phase,time_s,index,surface_phase,normal_speed_m_per_s,tangential_velocity_m_per_s,'
               'energy_loss_j,kind,count',
    'friction': 'epoch,tau,phase,time_s,impact_count,drag_velocity_m_per_s,eta,force_n,force_std_error_n,k_f_kg_per_s,'
                'k_f_std_error_kg_per_s,energy_loss_j,window_force_n,window_k_f_kg_per_s,window_k_f_std_error_kg_per_s,'
                'mean_lateral_force_n,mean_lateral_force_std_error_n,k_f_work_kg_per_s,k_f_work_std_error_kg_per_s,'
                'mean_normal_force_n,heat_to_bath_j'}
OF_THE_ROW = {'epoch', 'index', 'tau', 'phase', 'time_s'}  # the others are fields of the message
NOT_IN_TABLE = {'header', 'epoch', 'begin', 'time', 'first_impact', 'impact_limit', 'k_f_natural', 'window_k_f_natural',
                'k_f_work_natural'}


def call(*arguments):
    return run_tool(find('bag_to_csv'), *map(str, arguments))


def table(paths, *options):
    code, rows, complaint = call(*paths, *options)
    assert (code, complaint) == (0, ''), complaint
    return rows


def field_of(column, message):
    """The name of the field that a column shows: with a unit behind it, unless the field has one itself."""
    names = [column] + [column[:-len(unit)] for unit in UNITS if column.endswith(unit)]
    fields = [name for name in (OTHER_NAMES.get(name, name) for name in names) if hasattr(message, name)]
    assert fields, 'no field for the column %s; a unit behind it must be in UNITS' % column
    return fields[0]


class BagToCsv(NodeTest):
    def test_a_split_recording_topic_by_topic(self):
        emulator = self.record(record=True, sample_rate_hz=20000.0, temperature_k=300.0, quality_factor=100.0,
                               split_duration_s=0.4)
        applied, friction = Topic('applied'), Topic('friction')
        friction.wait_for()
        emulator.drag(2 * SPEED_UNIT)
        applied.wait_for(lambda m: m.drag_velocity == 2 * SPEED_UNIT)
        emulator.publisher('rest_height').publish(-1e-11)
        applied.wait_for(lambda m: m.rest_height_m == -1e-11)
        friction.wait_for_more(60)
        self.paths = self.end(emulator)
        self.assertGreater(len(self.paths), 1)
        self.check_rows()
        self.check_deflection()
        self.check_friction()
        reversed_paths = call(*self.paths[::-1], '--topic', 'friction')
        self.assertEqual(reversed_paths[:2], (0, self.table('friction')))  # a shell may list them in another order

    def table(self, topic):
        return table(self.paths, '--topic', topic)

    def recorded(self, topic):
        found = {message.header.seq: message for path in self.paths for message in bags.read(path)[topic]}
        return [found[seq] for seq in sorted(found)]

    def assert_row(self, row, message):
        """Every column has the value of its field, to the bit."""
        self.assertEqual((int(row['tau']), float(row['phase'])), (message.time.tau, message.time.phase))
        self.assertAlmostEqual(float(row['time_s']) / TAU_S, message.time.tau + message.time.phase, delta=1e-9)
        for column in set(row) - OF_THE_ROW:
            value = getattr(message, field_of(column, message))
            self.assertEqual(repr(type(value)(row[column])), repr(value), column)  # nan is nan

    def check_rows(self):
        """Of all but the samples: one for each message, and for each impact."""
        impacts = [impact for batch in self.recorded('impacts') for impact in batch.impacts]
        self.assertGreater(len(impacts), 1000)
        self.assertEqual([(int(row['epoch']), int(row['index'])) for row in self.table('impacts')],
                         [(0, index) for index in range(len(impacts))])
        commands = self.recorded('applied')
        self.assertEqual(len(commands), 3)
        for topic, found in (('impacts', impacts), ('friction', self.recorded('friction')), ('commands', commands)):
            rows = self.table(topic)
            self.assertEqual(len(rows), len(found), topic)
            for row, message in zip(rows, found):
                self.assert_row(row, message)
        for topic, names in NAMES.items():
            self.assertEqual(','.join(self.table(topic)[0]), names)

    def check_deflection(self):
        found = [(b.first_sample + i, (b.time.tau + b.time.phase) * TAU_S + i * b.sample_period, v, w)
                 for b in self.recorded('deflection') for i, (v, w) in enumerate(zip(b.vertical, b.lateral))]
        rows = self.table('deflection')
        self.assertEqual(len(rows), len(found))
        for row, (index, time, vertical, lateral) in zip(rows, found):
            self.assertEqual((int(row['index']), float(row['vertical_m']), float(row['lateral_m'])),
                             (index, vertical, lateral))
            self.assertAlmostEqual(float(row['time_s']), time, delta=1e-12)

    def check_friction(self):
        found, rows = self.recorded('friction'), self.table('friction')
        self.assertEqual({field_of(column, found[0]) for column in set(rows[0]) - OF_THE_ROW},
                         set(Friction.__slots__) - NOT_IN_TABLE)
        natural, last = table(self.paths, '--topic', 'friction', '--natural')[-1], found[-1]
        for name in ('k_f', 'window_k_f', 'k_f_work'):  # as table_writer_test.cpp has it of all
            expected = getattr(last, name + '_natural')
            self.assertAlmostEqual(float(natural[name + '_m_tip_per_tau']) / expected, 1, delta=1e-13)
        self.assertAlmostEqual(last.eta * SPEED_UNIT / last.drag_velocity, 1, delta=1e-12)
        self.assertAlmostEqual(last.k_f * last.drag_velocity / last.force, 1, delta=1e-9)
        self.assertTrue(last.force > 0.0 and last.k_f_std_error > 0.0)


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

    def test_messages_are_lost_at_the_ends(self):
        self.remove(*self.of('impacts')[:3], self.of('applied')[-1])
        path = self.write()
        for topic, lost in (('impacts', 3), ('commands', 1)):
            code, rows, complaint = call(path, '--topic', topic)
            self.assertEqual((code, complaint),
                             (UNCHECKED, 'bag_to_csv: warning: %d messages of %s are missing\n' % (lost, topic)))
            self.assertTrue(rows)

    def test_rosbag_record_may_lack_messages_at_the_ends(self):
        self.of('snapshot')[0].stamp += genpy.Duration(0, 1)  # it stamps what comes in by itself
        self.remove(*self.of('impacts')[:3])
        code, rows, complaint = call(self.write(), '--topic', 'impacts')
        self.assertEqual((code, complaint),
                         (SOUND, 'bag_to_csv: note: 3 batches at the ends have no message of /afm/impacts\n'))
        self.assertTrue(rows)

    def test_the_first_commands_are_lost(self):
        self.remove(*self.of('applied')[:2])
        for lost in (2, 1):  # rosbag record repeats the command in force before the snapshot in it alone
            code, rows, complaint = call(self.write(), '--topic', 'commands')
            self.assertEqual((code, complaint), (
                UNCHECKED, 'bag_to_csv: warning: %d messages of commands are missing\n' % lost))
            self.assertEqual([row['number'] for row in rows], ['2'])
            self.of('snapshot')[0].stamp += genpy.Duration(0, 1)

    def test_two_starts_are_noted(self):
        self.entries += [entry.shifted(100) for entry in self.entries]
        code, rows, complaint = call(self.write(), '--topic', 'friction')
        self.assertEqual((code, len(rows)), (SOUND, len(self.of('friction'))))
        self.assertIn('note: 2 starts of the node', complaint)

    def test_runs_of_two_frequencies_do_not_mix(self):
        self.of('configuration')[0].edit(omega_v_rad_per_s=80e3, tip_mass_kg=204e-12)  # of one unit of friction
        self.assertIn('different lattice spacings, frequencies or tip masses',
                      call(self.write(), '--topic', 'friction')[2])

    def test_a_bag_without_a_topic(self):
        self.remove(*self.of('deflection'), *self.of('snapshot'))
        path = self.write()
        for topic in ('impacts', 'friction', 'commands'):
            self.assertTrue(table([path], '--topic', topic))
        code, rows, complaint = call(path, '--topic', 'deflection')
        self.assertEqual((code, rows), (UNCHECKED, []))
        self.assertIn('holds no messages of this topic', complaint)

    def test_refuses_by_name(self):
        for arguments, code, words in (((self.good,), USAGE, 'topic = : must be impacts'),
                                       (('--topic', 'impacts'), USAGE, 'bags: must be given'),
                                       ((self.good, '--topic', 'samples'), USAGE,
                                        'topic = samples: must be impacts, deflection'),
                                       ((self.good, '--topic', 'impacts', '--node', '/other'), UNCHECKED, '/other'),
                                       (('/no/such.bag', '--topic', 'impacts'), UNCHECKED, '/no/such.bag'),
                                       ((self.good, self.good, '--topic', 'impacts'), USAGE, 'does not go on where')):
            answer = call(*arguments)
            self.assertEqual((answer[0], answer[1]), (code, []), answer)
            self.assertIn(words, answer[2])

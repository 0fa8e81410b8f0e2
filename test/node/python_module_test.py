"""The Python module simulates a recorded run again to the last bit."""
import time
import warnings
from pathlib import Path

import numpy as np
import rosbag
from afm_emulator.srv import Step
from std_srvs.srv import SetBool, Trigger

import afm
import bags
import checks
from emulator_under_test import SPEED_UNIT, NodeTest
from topics import Topic, wait_until

# what the topic ~friction says beside the estimate, and the estimate in other units
OF_THE_MESSAGE = {'header', 'epoch', 'begin', 'time', 'first_impact', 'impact_limit', 'drag_velocity', 'eta',
                  'k_f_natural', 'window_k_f_natural', 'k_f_work_natural'}


class PythonModule(NodeTest):
    def run_emulator(self, **parameters):
        self.emulator = self.record(record=True, **parameters)
        self.deflection, self.applied = Topic('deflection'), Topic('applied')
        self.deflection.wait_for()

    def command(self, *etas):
        before = len(self.applied.messages)
        for eta in etas:
            self.emulator.drag(eta * SPEED_UNIT)
            time.sleep(0.02)  # spreads the commands over batches; nothing is waited for
        wait_until(lambda: len(self.applied.messages) >= before + len(etas), 'commands are applied')

    def step_through(self):
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        for how_far in ({'tau': 10.25}, {'impacts': 7}, {'impacts': 1}):
            self.assertTrue(self.emulator.call('step', Step, **how_far).success)
            self.command(2.0, 3.0)
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)

    def assert_repeats(self, paths, epoch):
        """Samples and impacts that the bags hold are those of the module, in SI, bit for bit. Returns how many."""
        recording = afm.from_bag(paths, epoch=epoch)
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            run, units = recording.simulate(), recording.units
        messages = {name: [m for path in paths for m in bags.read(path)[name] if m.epoch == epoch]
                    for name in ('deflection', 'impacts', 'friction')}
        samples = 0
        for m in messages['deflection']:
            first = m.first_sample - run.first_sample
            for name in ('vertical', 'lateral'):
                mine = getattr(run, name)[first:first + len(m.vertical)] * units.length
                np.testing.assert_array_equal(mine, getattr(m, name), '%s from sample %d on' % (name, m.first_sample))
            samples += len(m.vertical)
        first = messages['deflection'][0]
        if first.first_sample == run.first_sample:
            self.assertEqual((first.time.tau, first.time.phase), tuple(run.first_sample_time))
            self.assertEqual(first.holder_position, run.holder * units.length)
        impacts = [(m.first_index + i, impact) for m in messages['impacts'] for i, impact in enumerate(m.impacts)]
        mine = run.impacts[[index - run.first_impact for index, _ in impacts]]
        for name, unit in (('normal_speed', units.velocity), ('tangential_velocity', units.velocity),
                           ('surface_phase', 1), ('energy_loss', units.energy), ('kind', 1), ('count', 1)):
            np.testing.assert_array_equal(mine[name] * unit, [getattr(impact, name) for _, impact in impacts], name)
        np.testing.assert_array_equal(mine['tau'], [impact.time.tau for _, impact in impacts])
        np.testing.assert_array_equal(mine['phase'], [impact.time.phase for _, impact in impacts])
        self.assertEqual(set(run.friction), set(messages['friction'][-1].__slots__) - OF_THE_MESSAGE)
        self.assertEqual(run.friction['k_f'] * units.friction, messages['friction'][-1].k_f)
        self.assertEqual(run.friction['heat_to_bath'] * units.energy, messages['friction'][-1].heat_to_bath)
        return recording, samples, len(impacts)

    def test_commands_steps_resets_live_parameters_heat_and_a_command_after_the_last_batch(self):
        self.run_emulator(sample_rate_hz=50000.0)
        self.command(2.0, -3.0, 0.0, 5.0, 1.0)
        self.step_through()
        self.deflection.wait_for_more(30)
        self.assertTrue(self.emulator.call('reset', Trigger).success)
        self.command(2.0)
        self.emulator.set(restitution_gamma=0.5, cutoff_speed=3e-7)
        self.command(3.0)
        self.emulator.set(temperature_k=77.0)  # without damping it has no effect
        self.emulator.set(temperature_k=300.0, quality_factor=50.0, kicks_per_tau=3.0)  # with too few, as the node says
        self.emulator.set(rest_height_m=-1e-11, sample_rate_hz=20000.0)
        self.command(2.5)
        self.deflection.wait_for_more(30)
        # it takes effect, but no batch shows it: the run ends with the batch before
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        self.command(5.0)
        path, = self.end(self.emulator)
        checks.assert_identical(self, path)
        epochs = afm.from_bag(path).epochs
        self.assertEqual(len(epochs), 2)
        for epoch, commands in zip(epochs, (1 + 5 + 6, 1 + 4 + 4)):
            recording, samples, impacts = self.assert_repeats([path], epoch)
            self.assertGreater(samples, 5000)
            self.assertGreater(impacts, 100)
            self.assertEqual(len(recording.commands), commands)
        self.assertEqual(recording.commands['drag_velocity'][-1], 5.0 * SPEED_UNIT)
        self.assertRaises(ValueError, afm.from_bag, path, epoch=99)
        self.assertRaises(ValueError, afm.from_bag, path, namespace='/other')
        self.check_what_is_missing(path)

    def test_a_command_at_once_under_a_load(self):
        """The tip begins on the surface, where an event is due; the command comes first, as in lockstep with a load."""
        emulator = self.record(record=True, load_n=0.4e-9, paused=True)
        self.applied = Topic('applied')
        self.applied.wait_for()
        emulator.drag(3.0 * SPEED_UNIT)
        self.applied.wait_for(lambda m: m.drag_velocity == 3.0 * SPEED_UNIT, 'the command')
        self.assertTrue(emulator.call('pause', SetBool, data=False).success)
        Topic('deflection').wait_for_more(5)
        self.assertGreater(self.assert_repeats(self.end(emulator), 0)[1], 0)

    def test_a_command_behind_a_step_to_an_impact(self):
        """At an impact after which the tip rests its contact begins, too: in the run, behind the command."""
        for parameters in {'rest_height_m': -1.56e-10}, {'restitution_gamma': 0.0, 'cutoff_speed': 0.0}:
            emulator = self.record(record=True, pace='lockstep', drag_velocity=2e-6, **parameters)
            for i in range(60):
                emulator.call('step', Step, impacts=1)
                emulator.control(0.0, 2e-6 * (1 + 0.01 * (i % 2)))
            emulator.control(0.005)
            path, = self.end(emulator)
            checks.assert_identical(self, path)
            afm.from_bag(path).simulate()

    def test_the_model_and_the_bath_of_a_recording(self):
        """Of a hammer it was an oscillator."""
        emulator = self.record(record=True, model='hammer', quality_factor=50.0, temperature_k=300.0,
                               contact_tolerance=1e-4)
        Topic('deflection').wait_for_more(3)
        emulator.set(restitution_gamma=0.5)
        path, = self.end(emulator)
        recording = afm.from_bag(path)
        tip = (recording.model.kind, recording.model.gamma, recording.bath.quality_factor, recording.contact_tolerance)
        self.assertEqual(tip, ('hammer', 0.7, 50.0, 1e-4))
        self.assertAlmostEqual(recording.bath.temperature * recording.units.temperature, 300.0)

    def test_a_split_recording(self):
        self.run_emulator(split_duration_s=0.4)
        self.command(*[2.0, -3.0, 5.0] * 15)
        self.deflection.wait_for_more(50)
        paths = self.end(self.emulator)
        self.assertGreaterEqual(len(paths), 3)
        recording, samples, _ = self.assert_repeats(paths, 0)
        self.assertEqual(len(recording.commands), 1 + 45)
        self.assertEqual(samples, sum(self.assert_repeats([path], 0)[1] for path in paths))
        self.assertGreater(float(afm.from_bag(paths[-1]).begin), 0.0)
        self.assert_repeats(paths[1:], 0)
        self.assertRaisesRegex(ValueError, 'are missing', afm.from_bag, paths[:1] + paths[2:])
        self.assertRaises(ValueError, afm.from_bag, [])

    def test_two_runs_on_the_clock_and_a_change_that_is_missing(self):
        """The stamps of both are the same model times."""
        paths = []
        for eta in 2.0, 3.0:
            self.run_emulator(publish_clock=True)
            self.command(eta)
            self.emulator.set(cutoff_speed=3e-7)
            self.deflection.wait_for_more(30)
            paths += self.end(self.emulator)
            Topic.close_all()
        self.assertRaisesRegex(ValueError, 'started twice', afm.from_bag, paths)
        unnamed = self.filtered(paths[0], lambda *_: True)
        self.assertEqual(afm.from_bag(paths + [unnamed], namespace='').eta, afm.from_bag(unnamed).eta)
        undone = self.filtered(paths[1], lambda topic, m: topic != 'applied' or m.number < 2)
        self.assertRaisesRegex(ValueError, 'is not as recorded, by', afm.from_bag(undone).simulate)

    def check_what_is_missing(self, path):
        """The whole run, or an error that names what it would take."""
        def altered(name, last=0, **values):
            """The snapshot, or of epoch 0 the message with this number."""
            def alter(topic, m):
                if topic == name and (m.epoch, m.header.seq) == (0, last):
                    bags.alter(m, **values)
                return True
            return alter
        last = max(m.header.seq for m in bags.read(path)['friction'] if m.epoch == 0)
        batches = 'deflection', 'impacts', 'friction'
        newest = bags.read(path)['friction'][-1].header.seq
        for keeps, words in ((lambda topic, m: topic != 'friction', 'Friction'),
                             (lambda topic, m: topic != 'snapshot', 'Snapshot'),
                             (lambda topic, m: topic != 'applied', 'Applied'),
                             (lambda topic, m: topic != 'friction' or m.header.seq != 20, 'Friction'),
                             (lambda topic, m: topic != 'friction' or m.header.seq < newest - 1, 'missing at the end'),
                             (lambda topic, m: topic not in batches or m.header.seq < newest - 5,
                              'message of EmulatorStatus says'),
                             (lambda topic, m: topic != 'status' and (topic not in batches or m.epoch == 0),
                              'message of Applied says'),
                             (lambda topic, m: topic not in batches or m.header.seq > 5, 'the first snapshot says'),
                             (lambda topic, m: topic != 'snapshot' or m.epoch > 0, 'begins before its first snapshot'),
                             (lambda topic, m: topic != 'applied' or m.number != 2, 'Applied'),
                             (lambda topic, m: topic != 'snapshot' or m.time.tau > 10, 'Snapshot'),
                             (lambda topic, m: topic != 'applied' or (m.epoch, m.number) != (0, 11), 'Applied'),
                             (altered('snapshot', configuration__version='0.0.1'), 'made by version 0.0.1'),
                             (lambda topic, m: topic != 'snapshot' and
                              altered('configuration', version='0.1.0')(topic, m), 'made by version 0.1.0'),
                             (altered('snapshot', configuration__arithmetic_digest='0' * 16), '0' * 16),
                             (altered('friction', last, time__tau=10 ** 9), 'batch %d does not' % last),
                             (altered('applied', 2, number=2 ** 64 - 1), 'Applied'),
                             (altered('friction', last, epoch=7), 'Friction are missing at the end of epoch 0'),
                             (altered('friction', last, impact_limit=10 ** 12), 'batch %d does not' % last)):
            with self.subTest(words=words):
                self.assertRaisesRegex(ValueError, words, afm.from_bag, self.filtered(path, keeps))
        longer = self.filtered(path, altered('applied', 2, sample_period_tau=0.15))
        # the mean of the last samples may show it first: their times are rounded otherwise from the next command on
        by = 'by (message [0-9]+ of Deflection|the mean_normal_force at its end)'
        self.assertRaisesRegex(ValueError, by, afm.from_bag(longer).simulate)
        spoiled = self.directory / 'spoiled.bag'
        spoiled.write_bytes(Path(path).read_bytes().replace(b'ModelTime time', b'ModelTime tim='))
        self.assertEqual(afm.from_bag(spoiled).end, afm.from_bag(path).end)
        without = self.filtered(path, lambda topic, m: topic != 'snapshot' or m.epoch == 0)
        self.assertEqual(afm.from_bag(without).epochs, afm.from_bag(path).epochs)
        self.assertRaisesRegex(ValueError, 'epoch = 1: the snapshot is missing', afm.from_bag, without, epoch=1)
        without = self.filtered(path, lambda topic, m: topic != 'deflection')
        np.testing.assert_array_equal(afm.from_bag(without).simulate().lateral, afm.from_bag(path).simulate().lateral)

    def filtered(self, path, keeps):
        filtered = str(self.directory / 'filtered.bag')
        with rosbag.Bag(path) as bag, rosbag.Bag(filtered, 'w') as kept:
            for topic, message, stamp in bag.read_messages():
                if keeps(bags.short(topic), message):
                    kept.write(topic, message, stamp)
        return filtered

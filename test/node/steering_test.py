#!/usr/bin/python3
"""Live parameters take effect as they are reported, faulty ones change nothing; without commands the drag stops."""
import math
import random
import subprocess
import time
from pathlib import Path

import dynamic_reconfigure.client
import rosbag
import rospy
from afm_emulator.srv import StartRecording
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

import checks
from emulator_under_test import SPEED_UNIT, Emulator, NodeTest, run
from topics import NAMESPACE, Topic, key, tau_between, wait_until

LIVE = ('restitution_gamma', 'cutoff_speed', 'rest_height_m', 'sample_rate_hz', 'friction_window_tau', 'temperature_k',
        'quality_factor', 'lateral_quality_factor', 'kicks_per_tau')
AT_START = {'restitution_gamma': 0.7, 'cutoff_speed': 1.66e-7, 'rest_height_m': 0.0, 'sample_rate_hz': 50000.0,
            'friction_window_tau': 1000.0, 'temperature_k': 0.0, 'quality_factor': 0.0, 'lateral_quality_factor': 0.0,
            'kicks_per_tau': 29.034}


def values(config):
    return {value.name: value.value for value in config.doubles}


class Steering(NodeTest):
    def run_emulator(self, **parameters):
        self.directory = Path(self.temporary_directory())
        self.emulator = self.start(Emulator(dict(sample_rate_hz=50000.0, record=True, bag_directory=str(self.directory),
                                                 **parameters)))
        self.applied, self.drags = Topic('applied_parameters'), Topic('applied_drag')
        self.deflection, self.friction = Topic('deflection'), Topic('friction')
        self.updates = []  # by a subscriber of the client's type, as rospy gives all subscribers of a topic the same messages
        subscriber = rospy.Subscriber(NAMESPACE + '/parameter_updates', Config, self.updates.append)
        self.addCleanup(subscriber.unregister)
        self.deflection.wait_for()
        wait_until(lambda: self.updates, 'updates')

    def end(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)
        return sorted(str(path) for path in self.directory.iterdir())

    def set(self, **wanted):
        """As a client does; returns the values in force after that."""
        config = Config(doubles=[DoubleParameter(name, value) for name, value in wanted.items()])
        return values(self.emulator.call('set_parameters', Reconfigure, config=config).config)

    def in_force(self):
        return values(self.updates[-1])

    def change(self, **wanted):
        """Returns the message that tells when it took effect."""
        before = len(self.applied.messages)
        answer = self.set(**wanted)
        self.assertEqual({name: answer[name] for name in wanted}, wanted)
        reported = self.applied.wait_for(lambda m: all(getattr(m, name) == wanted[name] for name in wanted), str(wanted), before)
        wait_until(lambda: self.in_force() == answer, 'clients see it')
        return reported

    def test_dynparam_and_clients_work(self):
        self.run_emulator()
        client = dynamic_reconfigure.client.Client(NAMESPACE, timeout=10)
        self.assertEqual({name: client.get_configuration(timeout=5)[name] for name in LIVE}, AT_START)
        described = {d['name']: d for d in client.get_parameter_descriptions(timeout=5)}
        self.assertEqual(set(described), set(LIVE))
        self.assertEqual((described['restitution_gamma']['min'], described['restitution_gamma']['max']), (0.0, 1.0))
        self.assertEqual(described['sample_rate_hz']['max'], 1e6)
        command = ['rosrun', 'dynamic_reconfigure', 'dynparam', 'set', NAMESPACE, 'restitution_gamma', '0.55']
        done = subprocess.run(command, timeout=30, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.applied.wait_for(lambda m: m.restitution_gamma == 0.55, 'dynparam is obeyed')
        self.assertEqual(client.update_configuration({'friction_window_tau': 640.0})['restitution_gamma'], 0.55)
        client.close()
        self.end()

    def test_a_change_takes_effect_at_a_batch_boundary_and_is_reported(self):
        self.run_emulator()
        self.friction.wait_for_more(30)
        reported = self.change(restitution_gamma=0.4, rest_height_m=-1.0e-11)
        first = self.friction.wait_for(lambda m: key(m.time) > key(reported.time), 'the first batch after it')
        batch = self.deflection.wait_for(lambda m: m.first_sample == reported.first_sample, 'begins with that sample')
        self.assertEqual(key(batch.time), key(reported.time))
        # the friction of the other model is forgotten, and the running estimate is of this batch alone
        self.assertLess(first.energy_loss, self.friction.messages[self.friction.messages.index(first) - 1].energy_loss)
        self.assertEqual(reported.sample_rate_hz, 50000.0)
        self.end()

    def test_a_new_sample_rate_begins_a_new_grid(self):
        self.run_emulator()
        reported = self.change(sample_rate_hz=80000.0)
        self.assertEqual(reported.samples_per_batch, 800)
        batch = self.deflection.wait_for(lambda m: m.first_sample == reported.first_sample, 'the first of the new grid')
        self.assertEqual(key(batch.time), key(reported.time))
        self.assertEqual((len(batch.vertical), batch.sample_period), (800, 1.0 / 80000.0))
        later = self.deflection.wait_for(lambda m: m.first_sample == reported.first_sample + 80000, 'a second later')
        tau = tau_between(reported.time, later.time)
        self.assertAlmostEqual(tau, 80000 * reported.sample_period_tau, delta=1e-9)
        self.end()

    def refuse(self, why, config):
        before = len(self.updates)
        answer = values(self.emulator.call('set_parameters', Reconfigure, config=config).config)
        self.assertEqual(answer, AT_START)
        wait_until(lambda: len(self.updates) > before, 'clients see the old values')
        self.assertEqual(self.in_force(), AT_START)
        self.assertIn(why, self.emulator.output())

    def test_faulty_changes_are_refused_with_reasons(self):
        self.run_emulator()
        faults = (('restitution_gamma', 1.5, 'between 0 and 1'), ('restitution_gamma', math.nan, 'between 0 and 1'),
                  ('cutoff_speed', -1e-9, 'not negative'), ('cutoff_speed', math.inf, 'finite'),
                  ('rest_height_m', 6e-11, 'never touches'), ('rest_height_m', -1.0, 'at most 10 lattice spacings'),
                  ('sample_rate_hz', 50.0, 'hold no sample'), ('sample_rate_hz', 1.1e6, 'between 1 and 1000000'),
                  ('friction_window_tau', 0.0, 'between 1 and 1000000000'),
                  ('temperature_k', -1.0, 'between 0 and'), ('quality_factor', 0.05, 'at least 0.1'),
                  ('kicks_per_tau', 0.0, 'between 0.01 and 1000'), ('tip_mass_kg', 1e-9, 'cannot be changed live'))
        for name, value, reason in faults:
            # the good part of a faulty change is not taken either
            good = DoubleParameter('friction_window_tau', 500.0) if name != 'friction_window_tau' else \
                DoubleParameter('cutoff_speed', 1e-7)
            self.refuse('refused: ' + name + ' = ', Config(doubles=[good, DoubleParameter(name, value)]))
            self.assertIn(reason, self.emulator.output())
        self.refuse('cannot be changed live', Config(bools=[BoolParameter('record', False)]))
        self.deflection.wait_for_more(3)
        self.assertEqual([{name: getattr(m, name) for name in LIVE} for m in self.applied.messages], [AT_START])
        paths = self.end()
        checks.assert_identical(self, *paths)

    def test_a_run_that_was_steered_is_repeated_to_the_last_bit(self):
        self.run_emulator(batch_rate_hz=500.0, split_duration_s=0.3, max_drag_velocity=1e-4)
        rng = random.Random(3)
        for i in range(60):
            wanted = {'restitution_gamma': rng.uniform(0.1, 0.95), 'cutoff_speed': rng.choice([0.0, 1e-8, 1.66e-7, 1e-6]),
                      'rest_height_m': rng.uniform(-1e-10, 4.9e-11), 'sample_rate_hz': rng.choice([5e4, 61234.5, 2e5]),
                      'friction_window_tau': rng.choice([100.0, 1000.0]), 'temperature_k': rng.choice([0.0, 77.0, 300.0]),
                      'quality_factor': rng.choice([0.0, 20.0, 100.0]), 'lateral_quality_factor': rng.choice([0.0, 500.0]),
                      'kicks_per_tau': rng.choice([2.0, 4.0, 7.3])}
            for name in rng.sample(LIVE[1:], rng.randrange(len(LIVE) - 1)):
                del wanted[name]
            if i % 20 == 10:
                self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
            self.change(**wanted)
            if rng.random() < 0.7:
                self.emulator.drag(rng.choice([0.0, 0.2, 0.5, 1.0, 3.0, -2.0, 3.4, 5.0]) * SPEED_UNIT)
            if i % 20 == 12:
                self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
            if i == 35:
                self.assertTrue(self.emulator.call('reset', Trigger).success)
                # what was changed stays changed: the new epoch begins with it
                reported = self.applied.wait_for(lambda m: m.epoch == 1, 'a new epoch')
                self.assertEqual({name: getattr(reported, name) for name in LIVE}, self.in_force())
                self.assertEqual((key(reported.time), reported.first_sample), ((0, 0.0), 0))
        self.deflection.wait_for_more(100)
        paths = self.end()
        self.assertGreater(len(paths), 1)
        checks.assert_identical(self, *paths)
        for path in paths:  # each can be read without the others
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, checks.SOUND, answer.text)

    def test_a_heated_run_begun_late_is_repeated_and_its_impacts_stand_the_check(self):
        self.run_emulator(temperature_k=300.0, quality_factor=100.0, seed=7)
        self.change(temperature_k=77.0, kicks_per_tau=3.0)
        self.assertTrue(self.emulator.call('stop_recording', Trigger).success)
        answer = self.emulator.call('start_recording', StartRecording, name='later.bag')
        self.assertTrue(answer.success, answer.message)
        self.deflection.wait_for_more(50)
        self.change(quality_factor=20.0)
        self.friction.wait_for_more(100)
        estimate = self.friction.messages[-1]
        self.assertNotEqual(estimate.heat_to_bath, 0.0)
        self.assertAlmostEqual(estimate.k_f_work * estimate.drag_velocity / estimate.mean_lateral_force, 1.0, delta=1e-12)
        for path in self.end():
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, checks.SOUND, answer.text)
            answer = checks.bag_check(path)
            self.assertEqual(answer.code, checks.SOUND, answer.text)
        # the last path: with 3 kicks a tau there are pairs of samples without one between them
        self.assertRegex(answer.text, r'ok  work .* at [1-9]\d* estimates of friction')

    def test_the_rest_height_is_commanded_by_topic_reported_and_repeated(self):
        self.run_emulator()
        height = rospy.Publisher(NAMESPACE + '/rest_height', Float64, queue_size=100)
        wait_until(lambda: height.get_num_connections() > 0, 'the node listens')
        before = len(self.applied.messages)
        for i in range(20):
            height.publish(-1e-12 * (i + 1))
        reported = self.applied.wait_for(lambda m: m.rest_height_m == -20e-12, 'the last of them', before)
        self.assertEqual([m.rest_height_m for m in self.applied.messages[before:]], [-1e-12 * (i + 1) for i in range(20)])
        for value, reason in ((6e-11, 'never touches'), (math.nan, 'finite'), (-1.0, 'at most 10 lattice spacings')):
            height.publish(value)
            wait_until(lambda: reason in self.emulator.output(), reason)
            time.sleep(1.1)  # refusals are reported once a second
        self.assertEqual(self.in_force()['rest_height_m'], reported.rest_height_m)
        paths = self.end()
        checks.assert_identical(self, *paths)

    def test_begun_in_mid_run_the_history_of_changes_is_recorded(self):
        self.run_emulator()
        self.change(rest_height_m=-3e-11, sample_rate_hz=30000.0)
        self.assertTrue(self.emulator.call('stop_recording', Trigger).success)
        self.change(restitution_gamma=0.8)
        answer = self.emulator.call('start_recording', StartRecording, name='later.bag')
        self.assertTrue(answer.success, answer.message)
        self.change(sample_rate_hz=40000.0)
        self.deflection.wait_for_more(20)
        self.end()
        checks.assert_identical(self, answer.path)
        spoiled = str(self.directory / 'spoiled.bag')  # one digit of a change that was made before the recording
        with rosbag.Bag(answer.path) as bag, rosbag.Bag(spoiled, 'w') as out:
            for topic, message, stamp in bag.read_messages():
                if topic == NAMESPACE + '/applied_parameters' and message.header.seq == 1:
                    self.assertEqual(message.rest_height_m, -3e-11)
                    message.rest_height_m = -3.0000000000000004e-11
                out.write(topic, message, stamp)
        self.assertEqual(checks.replay_check(spoiled).code, checks.ALTERED)

    def test_without_commands_the_drag_stops(self):
        self.run_emulator(command_timeout_s=1.0, drag_velocity=2.0 * SPEED_UNIT)
        stop = self.drags.wait_for(lambda m: m.drag_velocity == 0.0, 'it stops by itself')
        self.assertEqual([m.drag_velocity for m in self.drags.messages], [2.0 * SPEED_UNIT, 0.0])
        self.assertGreater(key(stop.time), (0, 0.0))
        # with commands it goes on
        begin = time.monotonic()
        while time.monotonic() - begin < 2.0:
            self.emulator.drag(SPEED_UNIT)
            self.deflection.wait_for_more(5)
        moving = [m.drag_velocity for m in self.drags.messages[2:]]
        self.assertEqual(set(moving), {SPEED_UNIT})
        count = len(self.drags.messages)
        wait_until(lambda: len(self.drags.messages) > count and self.drags.messages[-1].drag_velocity == 0.0, 'and stops')
        paths = self.end()
        checks.assert_identical(self, *paths)

    def test_time_in_a_pause_does_not_count(self):
        self.run_emulator(command_timeout_s=1.0)
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        begin, status = time.monotonic(), Topic('status')
        status.wait_for(lambda m: m.paused and time.monotonic() - begin > 1.5, 'time passes')
        self.assertEqual(len(self.drags.messages), 1)
        resumed = time.monotonic()
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        self.drags.wait_for(lambda m: m.drag_velocity == 0.0, 'stops after the pause')
        self.assertGreaterEqual(time.monotonic() - resumed, 1.0)
        self.end()

    def test_off_by_default(self):
        self.run_emulator()
        self.deflection.wait_for(lambda m: m.first_sample > 100000, 'two seconds')
        self.assertEqual(len(self.drags.messages), 1)
        self.end()


if __name__ == '__main__':
    run(Steering)

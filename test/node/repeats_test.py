"""A recorded run is simulated again to the last bit, whatever happened in it and wherever the recording begins."""
import os
import random
import signal
import time
from pathlib import Path

import rospy
from afm_emulator.srv import StartRecording, Step
from std_srvs.srv import SetBool, Trigger

import checks
from emulator_under_test import SHARE, SPEED_UNIT, NodeTest, Process, connected_to
from topics import NAMESPACE, Topic, wait_until

ETAS = [0.0, 1.0, 1.0, 2.0, -3.0, 3.4, 5.0, 5.0, 7.5, -1.0]  # contact, chatter, chaos, both directions
LEVELS = str(SHARE / 'config' / 'levels.csv')


class Repeats(NodeTest):
    def run_emulator(self, **parameters):
        self.random = random.Random(5)
        self.emulator = self.record(**parameters)
        self.deflection, self.applied = Topic('deflection'), Topic('applied')
        self.applied.wait_for()

    def command(self, count, pause_s=0.0):
        """Returns when all of them are applied."""
        before = len(self.applied.messages)
        for _ in range(count):
            self.emulator.drag(self.random.choice(ETAS + [self.random.uniform(-9, 9)]) * SPEED_UNIT)
            time.sleep(pause_s)  # spreads the commands over batches; nothing is waited for
        wait_until(lambda: len(self.applied.messages) >= before + count, 'commands are applied')

    def change_at_random(self):
        """Some of all live parameters."""
        chance = self.random
        values = {'restitution_gamma': chance.uniform(0.1, 0.95),
                  'cutoff_speed': chance.choice([0.0, 1e-8, 1.66e-7, 1e-6]),
                  'rest_height_m': chance.uniform(-1e-10, 4.9e-11),
                  'sample_rate_hz': chance.choice([5e4, 61234.5, 1.5e5]),
                  'friction_window_tau': chance.choice([100.0, 1000.0]),
                  'temperature_k': chance.choice([0.0, 77.0, 300.0]),
                  'quality_factor': chance.choice([0.0, 20.0, 100.0]),
                  'lateral_quality_factor': chance.choice([0.0, 500.0]),
                  'kicks_per_tau': chance.choice([2.0, 4.0, 7.3])}
        names = chance.sample(sorted(values), chance.randrange(1, len(values)))
        in_force = self.emulator.set(**{name: values[name] for name in names})
        self.assertEqual(set(in_force), set(values), 'every live parameter is changed')

    def call(self, service, kind=Trigger, **request):
        answer = self.emulator.call(service, kind, **request)
        self.assertTrue(answer.success, answer.message)
        return answer

    def step_through(self):
        self.call('pause', SetBool, data=True)
        for how_far in ({'tau': 10.25}, {'impacts': 7}, {'impacts': 1}, {'impacts': 1}, {'tau': 1e-3},
                        {'impacts': 2000}, {'tau': 700.0}):
            self.emulator.call('step', Step, **how_far)  # it ends early where the tip rests
            self.command(2)
        self.call('pause', SetBool, data=False)

    def test_a_command_that_changes_the_last_digit_of_si_alone(self):
        """To the run it is the same speed, and the estimate of friction goes on: bag_check once called that unsound."""
        emulator = self.record(pace='lockstep', record=True)
        for speed in (6.951887914253988e-06, 6.951887914253989e-06):  # eta = 2.1, both
            self.assertTrue(emulator.control(0.3, speed).success)
        checks.assert_identical(self, *self.end(emulator))

    def assert_each_is_identical(self, *paths):
        """Together, and each without the others."""
        checks.assert_identical(self, *paths)
        for path in paths:
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, checks.SOUND, answer.text)

    def test_all_that_can_happen_at_1_khz(self):
        self.run_emulator(record=True, batch_rate_hz=1000.0, split_size_mb=2.0)
        self.command(300)
        self.command(40, 0.003)
        self.step_through()
        self.call('reset')
        self.command(30, 0.004)
        self.call('reset')
        self.call('reset')
        self.step_through()
        self.deflection.wait_for_more(300)
        paths = self.end(self.emulator)
        self.assertGreater(len(paths), 2)
        checks.assert_identical(self, *paths)

    def test_begun_in_mid_run_split_and_changed_while_it_runs(self):
        self.run_emulator(time_scale=0.37, batch_rate_hz=250.0, split_duration_s=0.4, compression='lz4', model='auto',
                          tolerance=0.5, level_table=LEVELS)
        self.command(60, 0.005)
        self.call('reset')
        self.command(60, 0.005)
        self.call('start_recording', StartRecording, name='part')
        for _ in range(40):
            self.change_at_random()
            self.command(1)
        self.step_through()
        self.call('pause', SetBool, data=True)
        for _ in range(3):
            self.change_at_random()
        self.call('pause', SetBool, data=False)
        self.command(20)
        self.call('reset')
        self.command(20, 0.01)
        self.deflection.wait_for_more(100)
        self.call('stop_recording')
        paths = self.end(self.emulator)
        self.assertGreaterEqual(len(paths), 3)
        self.assertEqual([Path(path).name for path in paths],
                         ['part.bag'] + ['part_%03d.bag' % i for i in range(1, len(paths))])
        self.assertEqual({m.model for m in self.applied.messages}, {'oscillator', 'hammer'})
        self.assert_each_is_identical(*paths)
        lost = checks.replay_check(paths[0], *paths[2:])
        self.assertEqual(lost.code, checks.UNCHECKED, lost.text)
        self.assertIn('%s does not go on where %s ends' % (paths[2], paths[0]), lost.text)
        self.assertIn('what was compared is identical', lost.text)

    def record_with_rosbag(self, path):
        recorder = self.start(Process(['rosbag', 'record', '-a', '-O', path]))
        wait_until(lambda: os.path.exists(path + '.active'), 'rosbag records')
        return recorder

    def wait_for_subscribers(self, count):
        """Beside this test: rosbag looks for topics once a second, and subscribes to each by itself. The master knows
        of a subscriber before it is connected."""
        def number(topic):
            return len(connected_to(NAMESPACE + '/' + topic) - {rospy.get_name()})
        wait_until(lambda: all(number(topic) >= count
                               for topic in ('snapshot', 'applied', 'deflection', 'impacts', 'friction')),
                   'rosbag listens to the topics')

    def test_recorded_by_rosbag(self):
        """From before the node starts, and begun in its midst: the latched topics say how each epoch began."""
        first, late = (os.path.join(self.temporary_directory(), name) for name in ('first.bag', 'late.bag'))
        recorders = [self.record_with_rosbag(first)]
        # paused until rosbag listens, as a command among batches that it has in part makes them differ; and slow: it
        # gets what a busy machine lets it take
        self.run_emulator(time_scale=0.1, paused=True)
        self.wait_for_subscribers(1)
        self.call('pause', SetBool, data=False)
        self.command(20, 0.01)
        recorders.append(self.record_with_rosbag(late))
        self.wait_for_subscribers(2)
        self.call('reset')
        self.command(20, 0.01)
        self.deflection.wait_for_more(100)
        for recorder in recorders:
            recorder.stop(signal.SIGINT)
        self.end(self.emulator)
        answer = checks.replay_check(first)
        self.assertEqual(answer.code, checks.SOUND, answer.text)
        answer = checks.replay_check(late)  # of the first epoch it holds the last command alone
        self.assertEqual(answer.code, checks.UNCHECKED, answer.text)
        self.assertIn('commands, the first after model time 0 + 0 tau of epoch 0', answer.text)
        self.assertIn('what was compared is identical', answer.text)

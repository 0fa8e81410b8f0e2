#!/usr/bin/python3
"""A recording begun late begins with a checkpoint and few commands, and is simulated again from there to the last bit."""
import os
import random
import time
from io import BytesIO
from pathlib import Path

import dynamic_reconfigure.client
import rosbag
import roslib.packages
import rospy
from afm_emulator.srv import StartRecording
from std_srvs.srv import SetBool, Trigger

import bags
import checks
import digest_recipe
from emulator_under_test import PACKAGE, SPEED_UNIT, Emulator, NodeTest, run
from topics import NAMESPACE, TOPICS, Topic, key, wait_until

ETAS = [0.0, 1.0, 2.0, -3.0, 3.4, 5.0, 5.0, 7.5]
LEVELS = os.path.join(roslib.packages.get_pkg_dir(PACKAGE), 'config', 'levels.csv')
MOST_COMMANDS = 2000  # between two checkpoints


class Checkpoints(NodeTest):
    def run_emulator(self, **parameters):
        self.directory, self.random = Path(self.temporary_directory()), random.Random(3)
        self.emulator = self.start(Emulator(dict(parameters, bag_directory=str(self.directory))))
        self.deflection, self.applied = Topic('deflection'), Topic('applied_drag')
        self.checkpoint = Topic('checkpoint')
        for topic in (self.deflection, self.applied, self.checkpoint):
            topic.wait_for_connection()
        self.deflection.wait_for()

    def command(self, count, pause_s=0.0):
        """Returns when all of them are applied."""
        for _ in range(0, count, 500):
            chunk, before = min(count, 500), len(self.applied.messages)
            for _ in range(chunk):
                self.emulator.drag(self.random.choice(ETAS) * SPEED_UNIT)
                time.sleep(pause_s)  # spreads the commands over batches; nothing is waited for
            wait_until(lambda: len(self.applied.messages) >= before + chunk, 'commands are applied')

    def change(self, **values):
        dynamic_reconfigure.client.Client(NAMESPACE, timeout=10).update_configuration(values)

    def wait_for_checkpoint(self):
        """One that is of now or later."""
        now = self.deflection.messages[-1]
        return self.checkpoint.wait_for_next(lambda m: m.epoch == now.epoch and key(m.time) > key(now.time), 'a checkpoint')

    def record(self, name):
        answer = self.emulator.call('start_recording', StartRecording, name=name)
        self.assertTrue(answer.success, answer.message)
        return answer.path

    def stop_recording(self):
        self.assertTrue(self.emulator.call('stop_recording', Trigger).success)

    def end(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)

    def assert_from_checkpoint(self, *paths):
        checks.assert_identical(self, *paths)
        return self.assert_reported(checks.replay_check(*paths), checks.SOUND, 'simulated from the checkpoint at model time')

    def late_recording(self):
        """Of a run that has seen many commands, changes and checkpoints. Returns where it is, and what is in it."""
        self.run_emulator(checkpoint_interval_s=0.3, batch_rate_hz=250.0)
        self.command(250, 0.002)
        self.change(restitution_gamma=0.65, sample_rate_hz=150000.0)
        self.command(100, 0.002)
        self.wait_for_checkpoint()
        path = self.record('late')
        self.command(20, 0.01)
        self.change(rest_height_m=-2.0e-12, friction_window_tau=300.0)
        self.command(20, 0.01)
        self.wait_for_checkpoint()
        self.deflection.wait_for_more(50)
        self.stop_recording()
        return path, bags.read(path)

    def test_begun_late(self):
        path, messages = self.late_recording()
        self.end()
        first = messages['checkpoint'][0]
        self.assertGreater(first.drags, 100)
        self.assertLess(len(messages['applied_drag']), 250)
        self.assertEqual(messages['applied_drag'][0].header.seq, first.next_drag - 1)  # in force there
        self.assertEqual(messages['applied_drag'][0].drag_velocity, first.drag_velocity)
        self.assertEqual(messages['applied_parameters'][0].restitution_gamma, first.restitution_gamma)
        for reported in messages['checkpoint']:
            self.assertEqual(digest_recipe.of_checkpoint(reported), reported.state_digest)
        self.assertGreater(len(messages['checkpoint']), 1)
        answer = self.assert_from_checkpoint(path)
        self.assertNotIn(' 0 checkpoints', answer.text)

    def rewrite(self, path, edit):
        """The bag with its first checkpoint edited and its digest made to agree; closed as before."""
        spoiled, done = str(self.directory / 'spoiled.bag'), False
        with rosbag.Bag(path) as bag, rosbag.Bag(spoiled, 'w') as out:
            for topic, raw, stamp, header in bag.read_messages(raw=True, return_connection_header=True):
                if topic == NAMESPACE + '/checkpoint' and not done:
                    message, done = TOPICS['checkpoint']().deserialize(raw[1]), True
                    edit(message)
                    buffer = BytesIO()
                    message.serialize(buffer)
                    raw = (raw[0], buffer.getvalue()) + raw[2:]
                out.write(topic, raw, stamp, raw=True, connection_header=header)
        return spoiled

    def check_edited(self, path, edit):
        return checks.replay_check(self.rewrite(path, edit))

    def assert_reported(self, answer, code, *words):
        self.assertEqual(answer.code, code, answer.text)
        for word in words:
            self.assertIn(word, answer.text)
        return answer

    def test_altered_ones_are_reported(self):
        path, _ = self.late_recording()
        self.end()

        def another_word(message):
            words = list(message.state)
            words[21] ^= 1  # the last bit of the tip's restitution
            message.state = words

        def sign(message):
            message.state_digest = digest_recipe.of_checkpoint(message)

        def forged(change):
            def edit(message):
                change(message)
                sign(message)
            return edit
        self.assert_reported(self.check_edited(path, another_word), checks.ALTERED, 'not as it was recorded')
        self.assertEqual(checks.bag_check(str(self.directory / 'spoiled.bag')).code, checks.ALTERED)
        self.assert_reported(self.check_edited(path, forged(another_word)), checks.DIFFERS, 'FIRST DIFFERENCE')
        self.assert_reported(self.check_edited(path, forged(lambda m: setattr(m, 'layout', m.layout + 1))), checks.FOREIGN,
                         'layout', 'version')
        self.assert_reported(self.check_edited(path, forged(lambda m: setattr(m, 'state', m.state[:-1]))), checks.ALTERED,
                         'no state of this run')
        self.assert_reported(self.check_edited(path, forged(lambda m: setattr(m, 'samples', m.samples - 1))), checks.ALTERED,
                         'no state of this run')

        self.assert_history_is_missing_without(path)

    def assert_history_is_missing_without(self, path):
        bare = str(self.directory / 'bare.bag')
        with rosbag.Bag(path) as bag, rosbag.Bag(bare, 'w') as out:
            for topic, raw, stamp, header in bag.read_messages(raw=True, return_connection_header=True):
                if topic not in (NAMESPACE + '/checkpoint', NAMESPACE + '/recording'):
                    out.write(topic, raw, stamp, raw=True, connection_header=header)
        self.assert_reported(checks.replay_check(bare), checks.MISSING, 'history of commands')

    def test_a_flood_of_commands_while_paused(self):
        self.run_emulator(checkpoint_interval_s=3600.0)
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        self.command(3 * MOST_COMMANDS)
        self.assertGreaterEqual(len(self.checkpoint.messages), 3)
        counts = [message.drags for message in self.checkpoint.messages]
        self.assertLessEqual(max(b - a for a, b in zip(counts, counts[1:])), MOST_COMMANDS)
        path = self.record('flood')
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        self.deflection.wait_for_more(30)
        self.stop_recording()
        self.end()
        self.assertLessEqual(len(bags.read(path)['applied_drag']), MOST_COMMANDS + 1)
        self.assert_from_checkpoint(path)

    def test_split_over_a_reset(self):
        self.run_emulator(checkpoint_interval_s=0.2, split_duration_s=0.5, time_scale=0.7, batch_rate_hz=200.0,
                          model='auto', tolerance=0.5, level_table=LEVELS)
        self.command(50, 0.005)
        self.wait_for_checkpoint()
        self.record('part')
        self.command(100, 0.01)
        self.assertTrue(self.emulator.call('reset', Trigger).success)
        self.command(100, 0.01)
        self.deflection.wait_for_more(20)
        self.stop_recording()
        self.end()
        paths = sorted(str(path) for path in self.directory.iterdir())
        self.assertGreaterEqual(len(paths), 3)
        self.assertGreater(len({message.model for message in self.applied.messages}), 1)  # both levels of the model
        self.assert_from_checkpoint(*paths)
        for path in paths:  # each can be checked without the others
            for tool in (checks.replay_check, checks.bag_check):
                self.assert_reported(tool(path), checks.SOUND)
        self.assertLess(len(bags.read(paths[-1])['applied_drag']), 100)

    def test_a_listener_comes_late(self):
        """Who writes down what the topics tell, as `rosbag record` does, from a pause on."""
        self.run_emulator(checkpoint_interval_s=0.2)
        self.command(100, 0.002)
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        state = Topic('status').wait_for_next(lambda m: m.paused, 'paused')
        self.checkpoint.wait_for(lambda m: key(m.time) == key(state.time) and m.drags == len(self.applied.messages),
                                 'the state in which it is paused')
        Topic.close_all()
        heard = bags.listen()
        for topic in heard.values():
            topic.wait_for_connection()
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        heard['friction'].wait_for_more(20)
        self.emulator.drag(2.0 * SPEED_UNIT)
        heard['friction'].wait_for_more(50)
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        batches = [heard[name] for name in ('deflection', 'impacts', 'friction')]
        wait_until(lambda: len({topic.messages[-1].header.seq for topic in batches}) == 1, 'all of the last batch is heard')
        bag = str(self.directory / 'late.bag')
        with rosbag.Bag(bag, 'w') as out:
            for name, topic in heard.items():
                for i, message in enumerate(topic.messages):
                    out.write(NAMESPACE + '/' + name, message, rospy.Time(1000 + i))
        self.end()
        answer = self.assert_reported(checks.replay_check('--open-end', bag), checks.SOUND, 'from the checkpoint at model time')
        self.assertNotIn(' 0 checkpoints', answer.text)


if __name__ == '__main__':
    run(Checkpoints)

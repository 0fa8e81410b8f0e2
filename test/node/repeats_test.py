#!/usr/bin/python3
"""A recorded run is simulated again to the last bit, whatever happened in it."""
import multiprocessing
import random
import time
from pathlib import Path

from afm_emulator.srv import StartRecording, Step
from std_srvs.srv import SetBool, Trigger

import bags
import checks
from emulator_under_test import SPEED_UNIT, Emulator, NodeTest, run
from topics import Topic, wait_until

ETAS = [0.0, 1.0, 1.0, 2.0, -3.0, 3.4, 5.0, 5.0, 7.5, -1.0]  # contact, chatter, chaos, both directions


def burn():
    while True:
        pass


class Repeats(NodeTest):
    def run_emulator(self, **parameters):
        self.directory = Path(self.temporary_directory())
        self.random = random.Random(5)
        self.emulator = self.start(Emulator(dict(parameters, bag_directory=str(self.directory))))
        self.deflection, self.applied = Topic('deflection'), Topic('applied_drag')
        self.deflection.wait_for()

    def end(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)
        return sorted(str(path) for path in self.directory.iterdir())

    def command(self, count, pause_s=0.0):
        """Returns when all of them are applied."""
        before = len(self.applied.messages)
        for _ in range(count):
            self.emulator.drag(self.random.choice(ETAS + [self.random.uniform(-9, 9)]) * SPEED_UNIT)
            time.sleep(pause_s)  # spreads the commands over batches; nothing is waited for
        wait_until(lambda: len(self.applied.messages) >= before + count, 'commands are applied')

    def step_through(self):
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        for how_far in ({'tau': 10.25}, {'impacts': 7}, {'impacts': 1}, {'impacts': 1}, {'tau': 1e-3},
                        {'impacts': 2000}, {'tau': 700.0}):
            self.assertTrue(self.emulator.call('step', Step, **how_far).success)
            self.command(2)
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)

    def reset(self):
        self.assertTrue(self.emulator.call('reset', Trigger).success)

    def test_all_that_can_happen_at_1_khz(self):
        self.run_emulator(record=True, batch_rate_hz=1000.0)
        self.command(300)
        self.command(40, 0.003)
        self.step_through()
        self.reset()
        self.command(30, 0.004)
        self.reset()
        self.reset()
        self.step_through()
        self.deflection.wait_for_more(300)
        checks.assert_identical(self, *self.end())

    def test_begun_in_mid_run_and_split(self):
        self.run_emulator(time_scale=0.37, batch_rate_hz=250.0, split_duration_s=0.4, compression='lz4')
        self.command(60, 0.005)
        self.reset()
        self.command(60, 0.005)
        answer = self.emulator.call('start_recording', StartRecording, name='part')
        self.assertTrue(answer.success, answer.message)
        self.command(100, 0.01)
        self.reset()
        self.command(20)
        self.deflection.wait_for_more(100)
        self.assertTrue(self.emulator.call('stop_recording', Trigger).success)
        paths = self.end()
        self.assertGreaterEqual(len(paths), 3)
        parts = ['part_%03d.bag' % i for i in range(1, len(paths))]
        self.assertEqual([Path(path).name for path in paths], ['part.bag'] + parts)
        checks.assert_identical(self, *paths)
        for path in paths:  # each can be read without the others
            self.assertEqual(bags.info_exit_code(path), 0)
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, checks.SOUND, answer.text)
        self.assertIn('goes on in another bag', checks.replay_check(paths[0]).text)
        lost = checks.replay_check(paths[0], *paths[2:])
        self.assertEqual(lost.code, checks.MISSING, lost.text)
        self.assertIn('part 1 is missing', lost.text)
        self.assertEqual(checks.bag_check(paths[1], paths[1]).code, checks.REORDERED)

    def test_faster_than_real_time_and_split_by_size(self):
        self.run_emulator(record=True, time_scale=4.0, split_size_mb=2.0)
        self.command(50, 0.01)
        self.deflection.wait_for(lambda m: m.first_sample > 600000, 'three seconds of model time')
        paths = self.end()
        self.assertGreater(len(paths), 3)
        checks.assert_identical(self, *paths)

    def test_the_hammer_too(self):
        self.run_emulator(record=True, model='hammer')
        self.command(100, 0.005)
        self.step_through()
        self.deflection.wait_for_more(100)
        checks.assert_identical(self, *self.end())

    def test_the_hammer_brought_to_rest_again_and_again(self):
        self.run_emulator(record=True, model='hammer')
        for eta in 80 * (5.0, 0.0):
            self.emulator.drag(eta * SPEED_UNIT)
            time.sleep(0.02)  # on its way to rest; nothing is waited for
        checks.assert_identical(self, *self.end())

    def test_under_load(self):
        load = [multiprocessing.Process(target=burn, daemon=True) for _ in range(4)]
        for process in load:
            process.start()
            self.addCleanup(process.kill)
        self.run_emulator(record=True, batch_rate_hz=1000.0)
        self.command(50, 0.005)
        self.deflection.wait_for(lambda m: m.first_sample > 100000, 'half a second')
        checks.assert_identical(self, *self.end())


if __name__ == '__main__':
    run(Repeats)

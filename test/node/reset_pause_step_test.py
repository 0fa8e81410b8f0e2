#!/usr/bin/python3
"""Reset starts the same run again, pause holds model time, and a step goes exactly as far as it is asked to."""
import math

from afm_emulator.srv import Step
from std_srvs.srv import SetBool, Trigger

from emulator_under_test import SPEED_UNIT, EmulatorTest, run
from topics import TOPICS, Topic, key, tau_between, wait_until


class ResetPauseStep(EmulatorTest):
    def setUp(self):
        super().setUp()
        self.topics = {name: Topic(name) for name in TOPICS}
        for topic in self.topics.values():
            topic.wait_for_connection()
        self.status, self.deflection = self.topics['status'], self.topics['deflection']
        self.deflection.wait_for()

    def reset(self):
        self.assertTrue(self.emulator.call('reset', Trigger).success)

    def pause(self):
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        return self.status.wait_for_next(lambda m: m.paused, 'paused').time

    def step(self, **how_far):
        return self.emulator.call('step', Step, **how_far)

    def impacts_after(self, time):
        impacts = [i for message in self.topics['impacts'].messages for i in message.impacts]
        return [i for i in impacts if key(i.time) > key(time)]

    def first_of_epoch(self, name, epoch):
        return self.topics[name].wait_for(lambda m: m.epoch == epoch, 'epoch %d' % epoch)

    def samples_of_epoch(self, epoch, batches=10):
        def collected():
            messages = [m for m in self.deflection.messages if m.epoch == epoch]
            return [m.vertical + m.lateral for m in messages[:batches]] if len(messages) >= batches else None
        return wait_until(collected, 'batches of epoch %d' % epoch)

    def test_reset_raises_the_epoch_everywhere(self):
        epoch = self.deflection.messages[-1].epoch
        self.reset()
        first = {name: self.first_of_epoch(name, epoch + 1) for name in TOPICS}
        self.assertEqual((first['deflection'].first_sample, key(first['deflection'].time)), (0, (0, 0.0)))
        self.assertEqual(first['impacts'].first_index, 0)
        self.assertEqual(key(first['applied_drag'].time), (0, 0.0))
        for name, topic in self.topics.items():
            epochs = [m.epoch for m in topic.messages]
            self.assertEqual(epochs, sorted(epochs), name)

    def test_reset_starts_the_same_run_again(self):
        epoch = self.deflection.messages[-1].epoch
        self.emulator.drag(2.0 * SPEED_UNIT)
        self.topics['friction'].wait_for(lambda m: m.drag_velocity == 2.0 * SPEED_UNIT, 'another speed')
        for _ in range(2):
            self.reset()
            epoch += 1
            self.samples_of_epoch(epoch)
        self.assertEqual(self.samples_of_epoch(epoch - 1), self.samples_of_epoch(epoch))

    def test_pause_holds_model_time(self):
        time = self.pause()
        begin = len(self.status.messages)
        self.status.wait_for_more(3)
        self.assertEqual({key(m.time) for m in self.status.messages[begin:]}, {key(time)})
        self.assertLessEqual(max(key(m.time) for m in self.deflection.messages), key(time))
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        self.status.wait_for_next(lambda m: not m.paused and tau_between(time, m.time) > 1000, 'time passes again')

    def test_step_by_time(self):
        begin = self.pause()
        for tau in (0.25, 1e-6, 1.0, 33.3):
            answer = self.step(tau=tau)
            self.assertTrue(answer.success, answer.message)
            self.assertAlmostEqual(tau_between(begin, answer.time), tau, delta=1e-13)
            begin = answer.time
            self.status.wait_for_next(lambda m: key(m.time) == key(begin) and m.paused, 'the time reached')

    def test_step_to_the_next_impacts(self):
        begin = self.pause()
        reached = []
        for count in (1, 7, 200):
            answer = self.step(impacts=count)
            self.assertTrue(answer.success, answer.message)
            reached.append(answer.time)
        wait_until(lambda: len(self.impacts_after(begin)) >= 208, 'the impacts are published')
        times = [key(i.time) for i in self.impacts_after(begin)]
        self.assertEqual(len(times), 208)
        self.assertEqual([times[0], times[7], times[207]], [key(time) for time in reached])

    def test_samples_go_on_without_gap_through_steps(self):
        self.pause()
        for how_far in ({'tau': 100.5}, {'impacts': 300}, {'tau': 0.01}):
            self.assertTrue(self.step(**how_far).success)
        self.emulator.call('pause', SetBool, data=False)
        now = self.deflection.wait_for_next()
        self.deflection.wait_for(lambda m: m.first_sample > now.first_sample + 10 * len(now.vertical), 'running')
        messages = list(self.deflection.messages)
        for message, following in zip(messages, messages[1:]):
            self.assertEqual(message.first_sample + len(message.vertical), following.first_sample)

    def test_step_while_running_is_refused(self):
        answer = self.step(tau=1.0)
        self.assertFalse(answer.success)
        self.assertIn('pause', answer.message)

    def test_bad_steps_are_refused(self):
        time = self.pause()
        for how_far in ({}, {'tau': 1.0, 'impacts': 1}, {'tau': -1.0}, {'tau': math.nan}, {'tau': math.inf}):
            answer = self.step(**how_far)
            self.assertFalse(answer.success, how_far)
            self.assertTrue(answer.message, how_far)
        self.assertEqual(key(self.status.wait_for_next().time), key(time))


if __name__ == '__main__':
    run(ResetPauseStep)

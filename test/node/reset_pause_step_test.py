"""Reset starts the same run again, with the parameters of the start. Pause holds model time. A step goes exactly as far
as it is asked to, and a slow subscriber loses nothing in it, or what it loses is counted."""
import math
import signal
import time

from afm_emulator.srv import Step

import bags
from emulator_under_test import TAU_S, EmulatorTest
from tcpros import BareSubscriber
from topics import key, tau_between, wait_until

LONG_TAU = 10000  # the longest step there is


class ResetPauseStep(EmulatorTest):
    # a scene's commands
    parameters = {'sample_rate_hz': 100000.0, 'commands_eta': [3.4, 2.0, 0.0, -1.0], 'commands_hold_s': 0.02}

    def samples(self):
        return [m.vertical + m.lateral for m in self.topics['deflection'].messages]

    def test_reset_raises_the_epoch_everywhere(self):
        for name, topic in self.topics.items():
            first = topic.wait_for(what='of the new epoch')
            self.assertEqual({m.epoch for m in topic.messages}, {self.epoch}, name)
            if name in ('deflection', 'applied', 'snapshot'):
                self.assertEqual(key(first.time), (0, 0.0), name)
        first = {name: topic.messages[0] for name, topic in self.topics.items()}
        self.assertEqual((first['deflection'].first_sample, first['impacts'].first_index, first['applied'].number),
                         (0, 0, 0))
        self.assertEqual((first['applied'].cause, first['snapshot'].next_sample), ('epoch', 0))

    def test_a_scene_with_commands_repeats_to_the_bit(self):
        runs = []
        for _ in range(2):
            self.begin(paused=True)
            self.stepped(1000.0)
            # a command every 127 tau: the last of them in this time is the eighth
            self.topics['applied'].wait_for(lambda m: m.time.tau > 880, 'the last command')
            commands = [(key(m.time), m.cause, m.drag_velocity) for m in self.topics['applied'].messages]
            runs.append((self.samples(), commands))
        self.assertEqual(runs[0], runs[1])

    def test_reset_goes_back_to_the_parameters_of_the_start(self):
        names = ('restitution_gamma', 'rest_height_m', 'sample_rate_hz', 'drag_velocity', 'temperature_k')
        start = self.topics['applied'].messages[0]
        self.begin(paused=True)
        self.emulator.set(restitution_gamma=0.4, sample_rate_hz=50000.0, temperature_k=100.0)
        self.emulator.publisher('rest_height').publish(-1e-11)
        changed = self.topics['applied'].wait_for(lambda m: m.cause == 'rest_height', 'changed')
        self.assertEqual([getattr(changed, name) for name in names[:3]], [0.4, -1e-11, 50000.0])
        self.begin(paused=True)
        again = self.topics['applied'].messages[0]
        self.assertEqual([getattr(again, name) for name in names], [getattr(start, name) for name in names])
        self.assertEqual(self.emulator.set()['restitution_gamma'], 0.7)  # clients see it too

    def test_pause_holds_model_time(self):
        self.topics['deflection'].wait_for()
        self.pause(True)
        paused = self.topics['status'].wait_for_next(lambda m: m.paused, 'paused')
        self.assertEqual(paused.lag, 0.0)  # it owes nothing: the last batch's lag once stayed
        held = paused.time
        begin = len(self.topics['status'].messages)
        self.topics['status'].wait_for_more(3)
        self.assertEqual({key(m.time) for m in self.topics['status'].messages[begin:]}, {key(held)})
        self.assertLessEqual(max(key(m.time) for m in self.topics['deflection'].messages), key(held))
        self.pause(False)
        self.topics['status'].wait_for_next(lambda m: not m.paused and tau_between(held, m.time) > 500,
                                            'time passes again')

    def test_a_new_epoch_owes_nothing(self):
        """It once went on at full speed until the lag of the epoch before was made up."""
        self.emulator.child.send_signal(signal.SIGSTOP)
        stopped = time.monotonic()
        wait_until(lambda: time.monotonic() > stopped + 2.0, 'it falls behind')
        self.emulator.child.send_signal(signal.SIGCONT)
        asked = time.monotonic()
        self.begin()
        status = self.topics['status'].wait_for(lambda m: m.time.tau > 1000, 'model time passes')
        self.assertLess(status.time.tau * TAU_S, time.monotonic() - asked + 0.02)  # two batches

    def test_step_to_the_next_impacts(self):
        self.begin(paused=True)
        reached = [self.step(impacts=count) for count in (1, 7, 200)]

        def times():
            return [key(i.time) for m in self.topics['impacts'].messages for i in m.impacts]
        wait_until(lambda: len(times()) >= 208, 'the impacts are published')
        self.assertEqual(len(times()), 208)
        self.assertEqual([times()[0], times()[7], times()[207]], [key(time) for time in reached])

    def test_what_a_stopped_subscriber_loses_is_counted(self):
        dropped = self.status_now().dropped_messages
        deaf = BareSubscriber('deflection', '/deaf')
        self.addCleanup(deaf.socket.close)
        self.begin(paused=True)
        for _ in range(4):  # 10 MB, more than the kernel keeps for it
            self.stepped(LONG_TAU)
        self.status_now()
        lost = self.status_now().dropped_messages - dropped
        bags.assert_no_gap(self, self.topics['deflection'].messages)  # who listens has all
        last, got = self.topics['deflection'].messages[-1].header.seq, [deaf.read_message().header.seq]
        while got[-1] < last:
            got.append(deaf.read_message().header.seq)
        self.assertGreater(lost, 10)
        self.assertEqual(last - got[0] + 1 - len(got), lost)

    def test_step_while_running_is_refused(self):
        answer = self.emulator.call('step', Step, tau=1.0)
        self.assertFalse(answer.success)
        self.assertIn('pause', answer.message)

    def test_bad_steps_are_refused(self):
        self.begin(paused=True)
        for how_far in ({}, {'tau': 1.0, 'impacts': 1}, {'tau': -1.0}, {'tau': math.nan}, {'tau': math.inf},
                        {'tau': 10001.0}, {'impacts': 100001}):
            answer = self.emulator.call('step', Step, **how_far)
            self.assertFalse(answer.success, how_far)
            self.assertTrue(answer.message, how_far)
        self.assertEqual(key(self.status_now().time), (0, 0.0))

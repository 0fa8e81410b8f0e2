"""In lockstep the emulator advances when it is asked to; my_controller_test.sh tests that a closed loop repeats. Model
time on /clock rises strictly, whatever happens."""
import math
import threading
import time

import rospy
from afm_emulator import Client, EmulatorError
from afm_emulator.msg import Applied, Configuration
from afm_emulator.srv import Control, ControlResponse
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger

from emulator_under_test import ENERGY_UNIT, SPEED_UNIT, TAU_S, Emulator, EmulatorTest, NodeTest, Process, find
from tcpros import BareSubscriber
from topics import PATIENCE, Topic, key, tau_between, wait_until

K_H = 408e-12 * 250e3 ** 2  # [N/m]


class Lockstep(EmulatorTest):
    parameters = {'pace': 'lockstep', 'publish_clock': True, 'temperature_k': 300.0, 'quality_factor': 100.0}

    def advance(self, *arguments):
        answer = self.emulator.control(*arguments)
        self.assertTrue(answer.success, answer.message)
        return answer

    def test_a_period_is_as_long_as_it_is_asked_to_be(self):
        for duration in (0.01, 0.0123, 1e-6, 0.0):
            answer = self.advance(duration)
            self.assertAlmostEqual(tau_between(answer.begin, answer.end) * TAU_S, duration, delta=1e-12)

    def test_a_period_of_whole_batches_is_no_more_than_these(self):
        """One of a rounding's length followed it, or came after the next command with a force of one moment."""
        friction, periods = self.topics['friction'], (0.01, 0.03, 0.05) * 8
        first = self.advance(0.01).end
        for i, duration in enumerate(periods):
            end = self.advance(duration, (2 + i % 2) * SPEED_UNIT).end
        friction.wait_for(lambda m: key(m.time) == key(end), 'the end of the last period')
        lengths = [tau_between(m.begin, m.time) * TAU_S for m in friction.messages if key(m.time) > key(first)]
        self.assertEqual([round(length, 9) for length in lengths], [0.01] * round(sum(periods) / 0.01))

    def test_a_refused_period_has_no_force(self):
        """In a pause it was 0 N."""
        self.advance(0.01)
        self.pause(True)
        answer = self.emulator.control(0.01)
        self.pause(False)
        self.assertFalse(answer.success)
        self.assertTrue(math.isnan(answer.mean_lateral_force))
        self.assertEqual(key(answer.begin), key(answer.end))

    def test_an_answer_holds_what_was_published(self):
        self.advance(0.02)
        for speed in (2.0 * SPEED_UNIT, -2.0 * SPEED_UNIT):
            self.assert_holds_what_was_published(speed)

    def assert_holds_what_was_published(self, speed):
        answer = self.advance(0.03, speed, -1e-11)
        applied = self.topics['applied'].wait_for(lambda m: m.number == answer.applied, 'what is in force')
        self.assertEqual((applied.drag_velocity, applied.rest_height_m, key(applied.time)),
                         (speed, -1e-11, key(answer.begin)))
        self.topics['friction'].wait_for(lambda m: key(m.time) == key(answer.end), 'the end of the period')
        for name in ('deflection', 'impacts'):
            self.topics[name].wait_for(lambda m: m.header.seq == self.topics['friction'].messages[-1].header.seq,
                                       'of the same batch')
        batches = [m for m in self.topics['deflection'].messages if key(m.time) >= key(answer.begin)]
        lateral = [x for m in batches for x in m.lateral]
        self.assertEqual(answer.samples, len(lateral))
        impulse, seconds = sum(m.lateral_impulse for m in batches), tau_between(answer.begin, answer.end) * TAU_S
        self.assertAlmostEqual(answer.mean_lateral_force / (impulse / seconds), 1.0, delta=1e-9)
        self.assertAlmostEqual(answer.mean_lateral_force / (-K_H * sum(lateral) / len(lateral)), 1.0, delta=0.02)
        rms = math.sqrt(sum(x * x for x in lateral) / len(lateral))
        self.assertAlmostEqual(answer.rms_lateral_force / (K_H * rms), 1.0, delta=1e-9)
        impacts = [i for m in self.topics['impacts'].messages for i in m.impacts if key(i.time) > key(answer.begin)]
        self.assertEqual(answer.impact_count, sum(i.count for i in impacts))
        self.assertAlmostEqual(answer.energy_loss, sum(i.energy_loss for i in impacts), delta=1e-9 * ENERGY_UNIT)
        friction = self.topics['friction'].messages[-1]  # its estimate began with the command
        self.assertAlmostEqual(answer.k_f_work / friction.k_f_work, 1.0, delta=1e-9)
        self.assertAlmostEqual(answer.k_f / friction.k_f, 1.0, delta=1e-9)

    def test_what_cannot_be_is_refused_by_name_and_nothing_advances(self):
        now = key(self.advance(0.01).end)
        refused = self.topics['status'].messages[-1].refused_commands
        for name, request in (('drag_velocity', (0.01, 1.0)), ('rest_height', (0.01, math.nan, 1e-9)),
                              ('duration', (-0.01,)), ('duration', (math.nan,)), ('duration', (math.inf,)),
                              ('drag_velocity', (0.01, math.inf))):
            answer = self.emulator.control(*request)
            self.assertFalse(answer.success, request)
            self.assertIn(name, answer.message)
        self.topics['status'].wait_for_more(3)  # nor by itself
        self.assertEqual(self.topics['status'].messages[-1].refused_commands, refused + 6)
        self.assertEqual(key(self.advance(0.0).begin), now)

    def test_the_clock_rises_over_periods_and_resets(self):
        clock = Topic('/clock', Clock)
        clock.wait_for_connection()
        for _ in range(3):
            begin = len(clock.messages)
            answer = self.advance(0.05)
            wait_until(lambda: len(clock.messages) >= begin + 5, 'the clock')  # once a batch
            stamp = self.topics['friction'].wait_for(lambda m: key(m.time) == key(answer.end), 'the end').header.stamp
            wait_until(lambda: stamp in [m.clock for m in clock.messages], 'the end of the period on the clock')
            self.begin()
        self.assertLess(self.topics['status'].messages[-1].header.stamp.to_sec(), 1e6)  # of this clock too
        times = [m.clock.to_nsec() for m in clock.messages]
        self.assertGreater(times[0], 0)
        self.assertEqual(times, sorted(set(times)))

    def test_a_rate_that_begins_while_time_stands_still_is_over_with_its_batches(self):
        """A new subscriber was told a nanosecond more, which the batches did not reach."""
        self.advance(0.05)
        clock = Topic('/clock', Clock)
        begin = clock.wait_for().clock
        self.advance(0.05)
        clock.wait_for(lambda m: (m.clock - begin).to_nsec() >= 50000000, 'the end of five batches')

    def test_who_takes_the_place_of_another_gets_the_time(self):
        """The number of subscribers stayed the same. Nor is lost what waited for the one that left."""
        clock = BareSubscriber('/clock', kind=Clock)
        slow = BareSubscriber('deflection')
        for _ in range(3):
            self.advance(1.5)
            before, slow = slow, BareSubscriber('deflection')
            before.die()
            clock.die()
            clock = BareSubscriber('/clock', kind=Clock)
            self.advance(0.0)
            clock.read_message()
        self.assertEqual(Topic('status').wait_for_next().dropped_messages, 0)

    def test_a_second_clock_is_refused(self):
        rospy.set_param('/second', {'publish_clock': True})
        binary = self.emulator.child.args[0]
        second = self.start(Process([binary, '__name:=second']))
        self.assertEqual(second.wait(), 1)
        self.assertIn('/afm publishes /clock already', second.output())
        self.start(Process([binary, '__name:=second', '/clock:=/another']))  # that one is free
        Topic('/another', Clock).wait_for(what='its clock')


class Commanded(NodeTest):
    """By the list of a scene, which turns every 50 ms of model time."""
    def emulator(self):
        emulator = Emulator({'pace': 'lockstep', 'commands_eta': [2.0, -2.0], 'commands_hold_s': 0.05})
        return self.start(emulator)

    def test_it_turns_at_the_same_model_times_however_far_it_is_advanced_at_once(self):
        emulator = self.emulator()
        applied = Topic('applied', Applied)
        applied.wait_for_connection()
        turns = []
        for duration in (0.01, 0.03, 0.25):
            before = emulator.call('reset', Trigger) and len(applied.messages)
            for _ in range(round(0.75 / duration)):
                answer = emulator.control(duration)
            applied.wait_for(lambda m: m.epoch == answer.epoch and m.number == answer.applied, 'the last turn')
            turns.append([round(1e3 * (m.time.tau + m.time.phase) * TAU_S, 6) for m in applied.messages[before:]
                          if m.epoch == answer.epoch and m.cause == 'scene' and m.time.tau * TAU_S < 0.68])
        self.assertEqual(turns[0], [50.0 * i for i in range(14)])
        self.assertEqual(turns, turns[:1] * 3)
        emulator.assert_alive()

    def test_a_period_with_a_turn_in_it_has_no_friction_coefficient(self):
        emulator = self.emulator()
        answers = [emulator.control(duration) for duration in (0.05, 0.1)]
        for value in (answers[0].k_f, answers[0].k_f_work):
            self.assertTrue(math.isfinite(value), value)
        for value in (answers[1].k_f, answers[1].k_f_work):
            self.assertTrue(math.isnan(value), value)
        emulator.assert_alive()


class Waiting(NodeTest):
    def test_a_controller_that_knows_no_service_is_waited_for(self):
        emulator = self.start(Emulator({'pace': 'lockstep', 'wait_for': 'command', 'command_wait_s': 30.0}))
        friction = Topic('friction')
        friction.wait_for_connection()
        for i in range(1, 20):
            emulator.drag((2.0 + 0.01 * i) * SPEED_UNIT)
            friction.wait_for(lambda m: m.drag_velocity == (2.0 + 0.01 * i) * SPEED_UNIT, 'a batch for the command')
        self.assertEqual([m.drag_velocity for m in friction.messages if m.drag_velocity > 0][-19:],
                         [(2.0 + 0.01 * i) * SPEED_UNIT for i in range(1, 20)])
        emulator.assert_alive()

    def test_a_period_is_a_command_too(self):
        """A batch came by itself between the periods of a controller that used the service alone."""
        wait_s = 2.0 * PATIENCE
        emulator = self.start(Emulator({'pace': 'lockstep', 'wait_for': 'command', 'command_wait_s': wait_s}))
        answers, begin = [emulator.control(0.01, 2.0 * SPEED_UNIT)], time.monotonic()
        while time.monotonic() < begin + 1.5 * wait_s:
            last = time.monotonic()
            wait_until(lambda: time.monotonic() > last + wait_s / 4, 'a part of the wait')
            answers.append(emulator.control(0.01))
        for one, next_one in zip(answers, answers[1:]):
            self.assertEqual(key(one.end), key(next_one.begin))
        emulator.assert_alive()

    def test_it_does_not_wait_for_ever_and_a_pause_is_not_part_of_the_wait(self):
        wait_s = 1.0
        emulator = self.start(Emulator({'pace': 'lockstep', 'wait_for': 'command', 'command_wait_s': wait_s}))
        friction = Topic('friction')
        friction.wait_for_connection()
        emulator.call('pause', SetBool, data=True)
        end = time.monotonic() + wait_s
        wait_until(lambda: time.monotonic() > end, 'a pause as long as the wait')
        begin = time.monotonic()
        emulator.call('pause', SetBool, data=False)
        friction.wait_for_more(1)
        self.assertGreater(time.monotonic(), begin + wait_s)
        friction.wait_for_more(1)  # again and again
        self.assertEqual(Topic('status').wait_for(begin=1).late_batches, 0)  # nothing is late that waits
        emulator.assert_alive()


class RealTime(NodeTest):
    def test_a_ninth_period_is_refused_and_commands_are_not(self):
        emulator, answers = self.start(Emulator()), []
        periods = [threading.Thread(target=lambda: answers.append(emulator.control(60.0, 3e-6))) for _ in range(9)]
        for period in periods:
            period.start()
        wait_until(lambda: answers, 'one is refused')
        self.assertIn('eight control periods are under way', answers[0].message)
        self.assertTrue(emulator.control(0.0, 4e-6).success)
        Topic('deflection').wait_for_more(5)
        emulator.call('reset', Trigger)
        for period in periods:
            period.join()
        for answer in answers[1:]:
            self.assertEqual(answer.message, 'reset while it was measured')
            self.assertTrue(math.isfinite(answer.mean_lateral_force))  # up to then

    def test_the_clock_goes_at_the_rate_of_model_time(self):
        started = time.monotonic()
        self.start(Emulator({'publish_clock': True, 'time_scale': 4.0, 'sample_rate_hz': 50000.0}))
        clock = Topic('/clock', Clock)
        first, begin = clock.wait_for().clock, time.monotonic()
        last = clock.wait_for(lambda m: (m.clock - first).to_sec() > 8.0, 'eight seconds of model time').clock
        passed, end = (last - first).to_sec(), time.monotonic()
        # a busy machine may be late, and then catch up; never early
        self.assertGreater(passed, 0.5 * 4.0 * (end - begin))
        self.assertLess(passed, 4.0 * (end - started))


class TwoClocks(NodeTest):
    def test_of_two_that_begin_together_one_has_the_clock_at_most(self):
        """Each asked before the other had it."""
        parameters = {'publish_clock': True, 'pace': 'lockstep'}
        for name in ('left', 'right'):
            rospy.set_param('/' + name, parameters)
        both = [self.start(Process([find('emulator_node'), '__name:=' + name])) for name in ('left', 'right')]
        wait_until(lambda: any(process.child.poll() == 1 for process in both), 'one refuses')
        self.assertRegex(''.join(process.output() for process in both), '/(left|right) publishes /clock already')


class Starting(NodeTest):
    """The emulator advertises its topics before its services: a client that meets it between waits."""
    def topics_of(self, name):
        for topic, kind, message in (('configuration', Configuration, Configuration(pace='lockstep')),
                                     ('applied', Applied, Applied())):
            publisher = rospy.Publisher('%s/%s' % (name, topic), kind, queue_size=1, latch=True)
            publisher.publish(message)
            self.addCleanup(publisher.unregister)

    def test_a_client_waits_for_the_service(self):
        self.topics_of('/late')
        begin = threading.Timer(0.5, lambda: rospy.Service('/late/control', Control,
                                                           lambda _: ControlResponse(success=True, epoch=7)))
        begin.start()
        self.assertEqual(Client('/late').control(0.01).epoch, 7)

    def test_a_service_that_never_comes_is_named(self):
        self.topics_of('/never')
        with self.assertRaisesRegex(EmulatorError, '/never/control'):
            Client('/never', timeout=3.0)

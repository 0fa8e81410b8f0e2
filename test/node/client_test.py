"""The clients for controllers, in Python and in C++: every call ends in time and says why, at every pace, and the next
one works again."""
import math
import queue
import signal
import subprocess
import threading
import time
from pathlib import Path

from afm_emulator import Client, EmulatorError
from std_srvs.srv import SetBool, Trigger

from emulator_under_test import SPEED_UNIT, TAU_S, Emulator, NodeTest, connected_to, find
from topics import DEADLINE_S, PATIENCE, Topic, wait_until

TIMEOUT_S, LONG_S = 2.0 * PATIENCE, 15.0 * PATIENCE  # to see how it ends; for a busy machine
FAULTY = (('duration', 'control nan'), ('duration', 'control inf'), ('duration', 'control -0.01'),
          ('drag_velocity', 'control 0.01 nan'), ('rest_height', 'control 0.01 - nan'),
          ('drag_velocity', 'command_and_wait inf'), ('rest_height', 'command_and_wait - nan'),
          ('settle', 'mean_force 0.01 -1'), ('settle', 'mean_force 0.01 nan'), ('duration', 'mean_force -1'),
          ('duration', 'mean_force 0'))


def at(time):
    return time.tau + time.phase


class Calls:
    """A controller that calls what it is told."""

    def __init__(self, program, timeout_s=LONG_S):
        self.child = subprocess.Popen(program + ['%g' % timeout_s], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                      universal_newlines=True)
        self.answers = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()
        assert self.answer() == 'there'

    def _read(self):
        for line in self.child.stdout:
            if line.startswith('answer: '):
                self.answers.put(line[len('answer: '):].strip())
        self.answers.put(None)

    def answer(self):
        answer = self.answers.get(timeout=DEADLINE_S * PATIENCE)
        assert answer is not None, 'the controller has ended'
        return answer

    def begin(self, line):
        self.child.stdin.write(line + '\n')
        self.child.stdin.flush()

    def call(self, line):
        self.begin(line)
        return self.answer()

    def clean_up(self):
        self.child.kill()
        self.child.wait()
        self.child.stdin.close()


class Claims:
    """Of both clients."""
    def start_both(self, pace, timeout_s=LONG_S, **parameters):
        self.emulator = self.start(Emulator(dict(parameters, pace=pace)))
        return self.start(Calls(self.program(), timeout_s))

    def numbers(self, answer):
        self.assertNotIn('EmulatorError', answer)
        return [float(word) for word in answer.split()]

    def test_faulty_arguments_are_named_at_every_pace(self):
        for pace in ('lockstep', 'real_time'):
            tip = self.start_both(pace)
            for name, line in FAULTY:
                self.assertRegex(tip.call(line), '^EmulatorError: %s = ' % name, line)
            self.numbers(tip.call('mean_force 0.01'))
            self.assertEqual(Topic('status').wait_for().refused_commands, 0)  # none has come so far
            for line, name in (('control 0.01 2e-4', 'max_drag_velocity'), ('control 0.01 - 1', 'rest_height = '),
                               ('command_and_wait -2e-4', 'max_drag_velocity'),
                               ('command_and_wait - 1', 'rest_height = '),
                               ('control 0.01 - -1e-3', 'rest_height = ')):
                self.assertRegex(tip.call(line), '^EmulatorError: .*' + name)  # once sent, and waited for
            tip.clean_up()
            self.emulator.stop()

    def test_a_stopped_emulator(self):
        tip = self.start_both('lockstep', TIMEOUT_S)
        self.numbers(tip.call('control 0.01'))
        self.numbers(tip.call('another'))  # of which rospy keeps the connections, without a word of what they told
        for fault in ('did not answer', ''):  # then it does not even connect
            self.emulator.halt()
            begin = time.monotonic()
            answer = tip.call('control 0.01')
            self.assertLess(time.monotonic() - begin, 5.0 * TIMEOUT_S)
            self.assertRegex(answer, 'EmulatorError: /afm/.*%s.* within %g s' % (fault, TIMEOUT_S))
        self.emulator.child.send_signal(signal.SIGCONT)
        self.assertAlmostEqual(self.numbers(tip.call('control 0.02'))[0], 4000, delta=1)  # not that of a call before it

    def test_a_restarted_emulator(self):
        tip = self.start_both('lockstep')
        self.emulator.halt()  # the call gets no answer before the end
        tip.begin('control 0.01')
        self.emulator.child.kill()
        self.assertRegex(tip.answer(), 'EmulatorError: /afm/control: .*restarted')
        tip.begin('control 0.01')  # waits for the emulator
        self.emulator = self.start(Emulator({'pace': 'lockstep', 'omega_v_rad_per_s': 3e4}))
        self.assertAlmostEqual(self.numbers(tip.answer())[0], 2000, delta=1)
        self.assertEqual(tip.call('tau'), '0.00020944')  # the configuration was that of the dead emulator
        number, velocity, _ = self.numbers(tip.call('command_and_wait %r' % (2 * SPEED_UNIT)))
        self.assertEqual(number, 1)
        self.assertAlmostEqual(velocity / SPEED_UNIT, 2.0, delta=1e-4)

    def test_a_restarted_emulator_in_real_time(self):
        """Once a period was joined from both runs, with the impacts of neither."""
        tip = self.start_both('real_time')
        self.numbers(tip.call('control 0.01'))
        tip.begin('control 5')
        batches = Topic('deflection')
        batches.wait_for_more(20)
        self.emulator.child.kill()
        batches.close()
        self.emulator = self.start(Emulator({'pace': 'real_time'}))
        self.assertRegex(tip.answer(), 'EmulatorError: /afm/control: .*restarted')
        self.assertGreater(self.numbers(tip.call('control 0.01'))[0], 1999)
        self.emulator.child.kill()
        self.emulator = self.start(Emulator({'pace': 'real_time'}))
        self.assertRegex(tip.call('command_and_wait 3e-6'), 'EmulatorError: /afm/control: .*restarted')
        for call in ('command_and_wait 4e-6', 'command_and_wait 4e-6'):  # it is told once
            self.assertEqual(self.numbers(tip.call(call))[1], 4e-6)
        self.emulator.child.kill()
        self.emulator = self.start(Emulator({'pace': 'real_time'}))
        wait_until(lambda: self.numbers(tip.call('in_force')) == [0.0], 'it has heard of the new one')

    def test_what_is_in_force(self):
        """Right after a command `applied` was the message before it, more often than not."""
        for pace in ('lockstep', 'real_time'):
            tip = self.start_both(pace)
            self.assertEqual(tip.call('stale_reads 100'), '0')
            self.emulator.call('reset', Trigger)
            wait_until(lambda: tip.call('epoch') == '1', 'the configuration of the new epoch')  # without another call
            self.emulator.stop()

    def test_a_command_is_found_among_those_of_others(self):
        """The client in C++ looked at the latest message alone, and waited in vain."""
        tip = self.start_both('lockstep')
        others = [self.start(Calls(self.program())) for _ in range(2)]
        for i in range(100):
            for j, other in enumerate(others):
                other.begin('control 0 %r' % (1e-6 * (2 + j)))
            number, velocity, _ = self.numbers(tip.call('command_and_wait 4e-6'))
            self.assertEqual(velocity, 4e-6)
            for other in others:
                self.numbers(other.answer())

    def test_a_speed_commanded_where_a_period_begins(self):
        """By another, within the same batch: it is constant over the period, which had no friction coefficient."""
        tip = self.start_both('real_time', batch_rate_hz=1.0)
        other = self.start(Calls(self.program()))
        Topic('deflection').wait_for_next()
        tip.begin('control 1')
        other.begin('control 0 %r' % (2.0 * SPEED_UNIT))
        self.assertFalse(math.isnan(self.numbers(tip.answer())[3]))

    def test_the_number_of_what_is_in_force_at_the_end_of_a_period(self):
        """While another commands."""
        tip = self.start_both('real_time')
        applied, deflection = Topic('applied'), Topic('deflection')
        heights = self.emulator.publisher('rest_height')
        tip.begin('control 0.2')
        while tip.answers.empty():
            deflection.wait_for_next()
            heights.publish(-1e-10)
        heights.publish(-2e-10)
        applied.wait_for(lambda m: m.rest_height_m == -2e-10, 'the last command')
        _, number, _, _, end, *_ = self.numbers(tip.answer())
        before = [m.number for m in applied.messages if m.time.tau + m.time.phase < end - 1e-6]
        self.assertEqual(number, before[-1])

    def test_a_period_in_real_time_is_exact(self):
        """Also where its batches begin and end between samples: there it was that of its samples."""
        tip = self.start_both('real_time', impact_budget=30)  # 1000 batches a second; a busy machine lost of 4000
        deflection, friction = Topic('deflection'), Topic('friction')
        friction.wait_for_connection()
        deflection.wait_for_connection()
        for duration in (0.001, 0.013):
            *_, end, begin, force = self.numbers(tip.call('control %g' % duration))
            friction.wait_for(lambda m: at(m.time) > end + 1e-8, 'what follows')
            of_period = [m.header.seq for m in friction.messages
                         if begin - 1e-8 < at(m.begin) and at(m.time) < end + 1e-8]
            times = [at(m) for f in friction.messages if f.header.seq in of_period for m in (f.begin, f.time)]
            self.assertAlmostEqual(times[0], begin, delta=1e-8)
            self.assertAlmostEqual(times[-1], end, delta=1e-8)
            deflection.wait_for(lambda m: m.header.seq >= of_period[-1], 'the batches')
            impulse = sum(m.lateral_impulse for m in deflection.messages if m.header.seq in of_period)
            self.assertAlmostEqual(1e12 * impulse / ((end - begin) * TAU_S) / force, 1.0, delta=1e-6)
        *_, now, begin, _ = self.numbers(tip.call('control 0'))  # it was the time of the last command
        self.assertEqual(now, begin)
        self.assertGreaterEqual(now, end)

    def begin_period(self, duration, **parameters):
        """In real time."""
        tip = self.start_both('real_time', **parameters)
        tip.begin('control %g 3e-6' % duration)
        Topic('applied').wait_for(lambda m: m.drag_velocity == 3e-6, 'its begin')
        return tip

    def test_two_controllers_measure_at_once(self):
        """Each over batches of its own. A speed that changes has no friction coefficient."""
        tip = self.start_both('real_time')
        other = self.start(Calls(self.program()))
        tip.begin('control 3 3e-6')
        Topic('applied').wait_for(lambda m: m.drag_velocity == 3e-6, 'its begin')
        durations = (0.03, 0.1, 0.1)  # not rounded up to another batch: the sum of ten times 0.01 s is below 0.1 s
        answers = [self.numbers(other.call('control %g %r' % (duration, (2 + i) * SPEED_UNIT)))
                   for i, duration in enumerate(durations)]
        answers.append(self.numbers(tip.answer()))
        for (samples, *_, end, begin, _), duration in zip(answers, durations + (3.0,)):
            self.assertEqual(samples, round(200e3 * duration))
            self.assertAlmostEqual((end - begin) * TAU_S, duration, delta=1e-9)
        self.assertEqual([math.isnan(k_f) for _, _, _, k_f, *_ in answers], [False] * 3 + [True])

    def test_a_period_holds_neither_a_pause_nor_batches(self):
        """Once a client kept all of them, 31 MB in a second: it listens to none."""
        tip = self.begin_period(1.0)
        for paused in (True, False):
            self.emulator.call('pause', SetBool, data=paused)
        for topic in ('deflection', 'impacts', 'friction'):
            self.assertEqual(connected_to('/afm/' + topic), set())
        self.assertEqual(self.numbers(tip.answer())[0], 200000)

    def test_while_it_is_paused_commands_hold_and_nothing_is_measured(self):
        for pace in ('lockstep', 'real_time'):
            tip = self.start_both(pace, paused=True)
            self.assertRegex(tip.call('control 0.01 3e-6'), 'EmulatorError: /afm/control: the emulator is paused')
            self.assertEqual(self.numbers(tip.call('command_and_wait 4e-6'))[:2], [1, 4e-6])
            tip.clean_up()
            self.emulator.stop()

    def test_the_end_of_the_emulator_ends_a_period(self):
        """Where a node of its name came, roscpp ended the services first, and waited for the answer, which waited for
        the end."""
        for end in (lambda: self.emulator.child.send_signal(signal.SIGINT), lambda: self.start(Emulator())):
            tip, first = self.begin_period(60.0), self.emulator
            end()
            self.assertRegex(tip.answer(), 'EmulatorError: /afm/control: .*(shutting down|restarted)')
            self.assertEqual(first.wait(), 0)

    def test_an_emulator_and_a_controller_that_are_ended_together(self):
        """As by Ctrl-C of roslaunch: it is no fault that the emulator is first."""
        tip = self.begin_period(60.0)
        self.emulator.child.send_signal(signal.SIGINT)
        tip.child.send_signal(signal.SIGINT)
        self.assertEqual(tip.answer(), 'shut down')

    def test_a_period_of_less_than_a_batch_is_not_shorter(self):
        """Where a batch has two samples one of 2.4 was over with it."""
        tip = self.start_both('real_time', time_scale=2e-4, sample_rate_hz=1e6)
        samples, *_, end, begin, _ = self.numbers(tip.call('control 2.4e-6'))
        self.assertEqual(samples, 4)
        self.assertAlmostEqual((end - begin) * TAU_S, 4e-6, delta=1e-12)

    def test_a_command_returns_its_own_message(self):
        for pace in ('lockstep', 'real_time'):
            tip = self.start_both(pace)
            number = 0
            for line in ('command_and_wait 3e-6', 'command_and_wait 3e-6', 'command_and_wait 4e-6',
                         'command_and_wait - -1e-11', 'command_and_wait - -1e-11'):
                before, number = number, self.numbers(tip.call(line))[0]
                self.assertEqual(number, before + 1, line)
            self.assertEqual(self.numbers(tip.call('command_and_wait')), [number, 4e-6, -1e-11])
            tip.clean_up()
            self.emulator.stop()

    def test_a_mean_over_a_longer_time_than_a_period_can_have(self):
        tip = self.start_both('lockstep')
        self.assertIn('between 0 and 1.57', tip.call('control 4'))
        friction = Topic('friction')
        friction.wait_for_connection()
        force, = self.numbers(tip.call('mean_force 3 1.6'))

        def impulse(seconds):
            return seconds * friction.wait_for(lambda m: abs((m.time.tau + m.time.phase) * TAU_S - seconds) < 1e-9,
                                               '%g s of model time' % seconds).mean_lateral_force
        self.assertAlmostEqual(3.0 * force / (impulse(4.6) - impulse(1.6)), 1.0, delta=1e-6)

    def test_a_mean_force_is_of_what_was_commanded(self):
        """Once it went over a reset, and over commands of others."""
        tip, other = self.start_both('lockstep'), self.start(Calls(self.program()))
        batches, mean = Topic('deflection'), 'mean_force 60000 0 3e-6'  # no end before it is disturbed
        batches.wait_for_connection()
        for disturb, what in ((lambda: self.emulator.call('reset', Trigger), 'reset'),
                              (lambda: other.call('control 1e-3 2e-6'), 'another command or change took effect'),
                              (lambda: other.call('control 1e-3'), 'another controller advanced it')):
            tip.begin(mean)
            batches.wait_for_more(10)
            disturb()
            self.assertRegex(tip.answer(), 'EmulatorError: /afm: %s' % what)
        self.emulator.stop()
        tip = self.start_both('real_time', command_timeout_s=0.2)
        self.assertRegex(tip.call('mean_force 0.5 0 3e-6'), 'EmulatorError: /afm: another command or change')
        self.numbers(tip.call('mean_force 0.5'))

    def test_a_mean_force_is_not_of_samples(self):
        """The hammer's are zero along x. On its periodic orbit at eta = 2 every period has the same force."""
        for pace in ('lockstep', 'real_time'):
            tip = self.start_both(pace, model='hammer', cutoff_speed=1.66e-7)
            friction = Topic('friction')
            friction.wait_for_connection()
            force, = self.numbers(tip.call('mean_force 0.1 0.1 %r' % (2.0 * SPEED_UNIT)))
            estimate = friction.wait_for(lambda m: abs(m.eta - 2.0) < 1e-9 and m.impact_count > 2000, 'long after that')
            self.assertAlmostEqual(force / estimate.mean_lateral_force, 1.0, delta=0.02)
            tip.clean_up()
            self.emulator.stop()
            Topic.close_all()

    def test_the_node_is_shut_down_while_it_waits(self):
        tip = self.start_both('lockstep')
        self.emulator.halt()
        tip.begin('control 0.01')
        tip.child.send_signal(signal.SIGINT)
        self.assertEqual(tip.answer(), 'shut down')
        self.emulator.child.send_signal(signal.SIGCONT)


class Python(Claims, NodeTest):
    def program(self):
        return ['/usr/bin/python3', str(Path(__file__).with_name('client_calls.py'))]

    def test_calls_from_several_threads_take_turns(self):
        """As from callbacks of rospy."""
        tip = self.start_both('lockstep')
        self.assertEqual(tip.call('control_in_threads 1e-3 2e-3'), '1000 2000')

    def test_a_text_or_a_truth_value_is_no_number(self):
        tip = self.start_both('lockstep')
        self.assertRegex(tip.call('control True'), '^EmulatorError: duration = True: must be a finite number')
        self.assertRegex(tip.call("control '0.01'"), '^EmulatorError: duration = ')
        self.assertRegex(tip.call("control 0.01 '3e-6'"), '^EmulatorError: drag_velocity = ')
        self.assertAlmostEqual(self.numbers(tip.call('control 0.02'))[0], 4000, delta=1)  # no half request is before it

    def test_a_name_that_no_node_can_have(self):
        """Is refused at once. A legal one, relative or private, is waited for."""
        for name in ('a fm', '', '/', 'a//b', '5', None, 5):
            self.assertRaisesRegex(EmulatorError, '^name = %r: must be the name of a node' % (name,), Client, name, 1e9)
        for name in ('nobody', 'of/nobody', '/nobody', '~nobody'):
            self.assertRaisesRegex(EmulatorError, 'nobody/control: was not there within 0 s', Client, name, 0.0)


class Cpp(Claims, NodeTest):
    def program(self):
        return [str(Path(find('emulator_node')).parents[1] / 'client_calls')]

"""What happens around a running emulator: it goes on, or says what it did not do; and its recording stays whole."""
import itertools
import math
import os
import signal
import struct
import threading
import time
import xmlrpc.client
from pathlib import Path
from unittest import mock

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.msg import Config
from std_srvs.srv import SetBool

import bags
import checks
from emulator_under_test import Emulator, NodeTest, Process, find
from own_master import own_master
from tcpros import BareSubscriber
from topics import NAMESPACE, PATIENCE, Topic, wait_until

DISTURBANCES = str(Path(find('emulator_node')).parents[1] / 'libafm_disturbances.so')
MODEL_RATE = 40e3 / (2 * 3.141592653589793)  # tau in a second


class Faults(NodeTest):
    def recording_emulator(self, **environment):
        emulator = self.record(environment, record=True)
        self.status, self.deflection = Topic('status'), Topic('deflection')
        self.deflection.wait_for_connection()
        self.status.wait_for(lambda m: m.recording and m.time.tau > 1000, 'recording')
        return emulator

    def assert_keeps_up(self):
        """Over half a second of wall time."""
        begin, since = self.status.wait_for_next(), time.monotonic()
        end = self.status.wait_for_next(lambda m: m.time.tau - begin.time.tau > 0.5 * MODEL_RATE, 'half a second on')
        self.assertLess(time.monotonic() - since, 5.0)
        self.assertLess(end.lag, 1.0)

    def recording_emulator_of(self, master):
        self.directory = Path(self.temporary_directory())
        master.setParam('test', NAMESPACE, {'record': True, 'bag_directory': str(self.directory)})
        emulator = self.start(Process([find('emulator_node'), '__name:=' + NAMESPACE[1:]]))
        wait_until(lambda: NAMESPACE + '/stop_recording' in str(master.getSystemState('test')[2]),
                   'the last of it is registered')
        BareSubscriber('status', master=master).read_message()
        return emulator

    def assert_ends_soon(self, emulator):
        asked = time.monotonic()
        self.assertEqual(emulator.stop(), 0)
        self.assertLess(time.monotonic() - asked, 5.0 * PATIENCE)
        path, = self.directory.iterdir()
        checks.assert_identical(self, str(path))

    def test_the_master_hangs(self):
        """The bag was closed after it had answered."""
        with mock.patch.dict(os.environ), own_master() as master:  # for its children alone
            emulator = self.recording_emulator_of(master)
            _, _, pid = master.getPid('test')
            os.kill(pid, signal.SIGSTOP)
            self.assert_ends_soon(emulator)
            begins = self.start(Process([find('emulator_node'), '__name:=' + NAMESPACE[1:]]))
            wait_until(lambda: len(list(Path('/proc/%d/task' % begins.child.pid).iterdir())) > 1, 'it awaits signals')
            self.assertEqual(begins.stop(), 0)

    def test_the_master_dies(self):
        """The run, its subscribers and its recording do not need it."""
        with mock.patch.dict(os.environ), own_master() as master:
            emulator = self.recording_emulator_of(master)
            heights = [-1e-11, -2e-11]
            for height in heights:  # one after the other: each changes a live parameter
                self.start(Process(['rostopic', 'pub', '-r', '3', NAMESPACE + '/rest_height', 'std_msgs/Float64', '--',
                                    '%.1e' % height]))
            applied = BareSubscriber('applied', master=master)
            while heights:
                height = applied.read_message().rest_height_m
                heights = [other for other in heights if other != height]
            listener = BareSubscriber('deflection', master=master)
            before = listener.read_message()
        # the master is killed
        self.assertIsNone(emulator.child.poll())
        while listener.read_message().first_sample < before.first_sample + 400000:
            pass  # two seconds of the run
        self.assert_ends_soon(emulator)

    def test_what_happens_around_a_recording(self):
        """One after another, to one run: no time on /clock, subscribers that die, a wall clock that jumps, and a long
        halt."""
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.jump = Path(self.temporary_directory()) / 'jump'
        self.jump.write_bytes(struct.pack('d', 0.0))
        self.emulator = self.recording_emulator(LD_PRELOAD=DISTURBANCES, CLOCK_JUMP=str(self.jump))
        for step in (self.time_without_a_clock, self.subscribers_are_killed, self.the_wall_clock_jumps,
                     self.it_jumps_in_a_pause):
            step()
            bags.assert_no_gap(self, self.deflection.messages)
        self.assertEqual(self.status.wait_for_next().dropped_messages, 0)
        self.stop_for(1.0)
        self.stop_for(3.0)  # more than the queue to the publishing thread holds
        # the recording is whole; what comes faster than this subscriber takes it may be lost to it, and is counted
        self.status.wait_for_next()
        counted, seen = self.status.wait_for_next().dropped_messages, [m.header.seq for m in self.deflection.messages]
        self.assertEqual(seen[-1] - seen[0] + 1 - len(seen), counted)
        checks.assert_identical(self, *self.end(self.emulator))

    def test_who_subscribes_while_a_command_is_published_gets_that(self):
        """roscpp's own latch takes a message after it has sent it."""
        emulator = self.start(Emulator(LD_PRELOAD=DISTURBANCES, HOLD_UP=NAMESPACE + '/applied'))
        applied = Topic('applied')
        for number, speed in enumerate((None, 1e-6, 2e-6)):
            if speed:
                emulator.drag(speed)
            applied.wait_for(lambda m, n=number: m.number == n)
            self.assertEqual(BareSubscriber('applied').read_message().number, number)
        self.assertIn('held up', emulator.output())

    def test_who_subscribes_while_commands_wait_to_be_sent_gets_them_in_order(self):
        """The last was followed by those before it."""
        emulator = self.start(Emulator(LD_PRELOAD=DISTURBANCES, SEND_LATE='1'))
        Topic('applied').wait_for()
        ended = threading.Event()

        def command():
            for i in itertools.count():
                emulator.drag(1e-6 * (1 + i % 2))
                if ended.wait(0.005):
                    return
        commands = threading.Thread(target=command)
        commands.start()
        try:
            for _ in range(5):
                subscriber = BareSubscriber('applied')
                numbers = [subscriber.read_message().number for _ in range(20)]
                self.assertEqual(numbers, list(range(numbers[0], numbers[0] + 20)))
                subscriber.die()
            self.assertIn('sent late', emulator.output())
        finally:
            ended.set()
            commands.join()

    def test_a_slider_shows_what_was_set_while_it_came(self):
        emulator = self.start(Emulator(LD_PRELOAD=DISTURBANCES, HOLD_UP=NAMESPACE + '/parameter_updates'))
        updates = Topic('parameter_updates', Config)

        def gamma(message):
            return next(value.value for value in message.doubles if value.name == 'restitution_gamma')
        updates.wait_for(lambda m: gamma(m) == 0.7)
        threading.Thread(target=emulator.set, kwargs={'restitution_gamma': 0.5}).start()
        updates.wait_for(lambda m: gamma(m) == 0.5)
        late = BareSubscriber('parameter_updates', kind=Config)
        wait_until(lambda: gamma(late.read_message()) == 0.5, 'the slider is set')
        self.assertIn('held up', emulator.output())

    def time_without_a_clock(self):
        self.assertLess(abs(self.status.wait_for_next().header.stamp.to_sec() - time.time()), 60.0)
        Topic('/diagnostics', DiagnosticArray).wait_for(
            lambda m: any(s.name == 'afm: emulation' for s in m.status), 'diagnostics')
        self.emulator.drag(math.nan)
        wait_until(lambda: 'refused: drag_velocity = nan' in self.emulator.output(), 'it is logged')

    def subscribers_are_killed(self):
        for name in ('deflection', 'impacts', 'friction'):
            victim = BareSubscriber(name)
            victim.read_half_a_message()
            victim.die()
        self.deflection.wait_for_more(20)
        self.assertEqual(self.status.wait_for_next().dropped_messages, 0)

    def jump_by(self, hours):
        with open(str(self.jump), 'r+b') as file:
            file.write(struct.pack('d', 3600.0 * hours))

    def the_wall_clock_jumps(self):
        for hours in (1, -2, 24 * 365):
            self.jump_by(hours)
            jumped = self.status.wait_for_next(
                lambda m, h=hours: abs(m.header.stamp.to_sec() - time.time() - 3600 * h) < 60, 'stamps of the new time')
            self.assert_keeps_up()
            self.assertLess(jumped.worst_lag, 5.0)

    def it_jumps_in_a_pause(self):
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        self.jump_by(-1)
        self.status.wait_for_next(lambda m: m.paused, 'paused')
        self.status.wait_for_more(3)
        self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        self.assert_keeps_up()

    def stop_for(self, seconds):
        self.emulator.halt()
        time.sleep(seconds)
        before = self.deflection.messages[-1]
        self.emulator.child.send_signal(signal.SIGCONT)
        self.deflection.wait_for_next(
            lambda m: m.time.tau - before.time.tau > seconds * MODEL_RATE, 'all that time made up for')
        status = self.status.wait_for_next(lambda m: m.lag < 0.5 and m.worst_lag > 0.9 * seconds,
                                           'was late, and says so')
        self.assertGreater(status.late_batches, 0)

    def test_two_of_one_name(self):
        first = self.recording_emulator()
        second = self.start(Emulator({}))
        self.assertEqual(first.wait(), 0)
        path, = self.directory.iterdir()
        checks.assert_identical(self, str(path))
        second.assert_alive()
        wait_until(lambda: xmlrpc.client.ServerProxy(rospy.get_master().lookupNode(NAMESPACE)[2]).getPid('test')[2]
                   == second.child.pid, 'the second has the name')
        self.assertEqual(second.stop(), 0)

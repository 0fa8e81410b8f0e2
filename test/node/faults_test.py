#!/usr/bin/python3
"""What happens around a running emulator: it goes on, or says what it did not do; and its recording stays whole."""
import signal
import struct
import time
import xmlrpc.client
from pathlib import Path

import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import SetBool, Trigger

import checks
from emulator_under_test import PACKAGE, Emulator, NodeTest, run, set_parameters
from master import Master
from tcpros import BareSubscriber
from topics import NAMESPACE, TOPICS, Topic, wait_until

MODEL_RATE = 40e3 / (2 * 3.141592653589793)  # tau in a second


class Faults(NodeTest):
    def recording_emulator(self, **environment):
        self.directory = Path(self.temporary_directory())
        emulator = self.start(Emulator({'record': True, 'bag_directory': str(self.directory)}, **environment))
        self.status, self.deflection = Topic('status'), Topic('deflection')
        self.deflection.wait_for_connection()
        self.status.wait_for(lambda m: m.recording and m.time.tau > 1000, 'recording')
        return emulator

    def end(self, emulator):
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        path, = self.directory.iterdir()
        checks.assert_identical(self, str(path))

    def assert_no_sample_lost(self):
        messages = self.deflection.messages
        for message, following in zip(messages, messages[1:]):
            self.assertEqual(message.first_sample + len(message.vertical), following.first_sample)

    def assert_keeps_up(self):
        """Over half a second of wall time."""
        begin, since = self.status.wait_for_next(), time.monotonic()
        end = self.status.wait_for_next(lambda m: m.time.tau - begin.time.tau > 0.5 * MODEL_RATE, 'half a second on')
        self.assertLess(time.monotonic() - since, 5.0)
        self.assertLess(end.lag, 1.0)

    def test_the_master_dies_and_comes_back(self):
        self.directory = Path(self.temporary_directory())
        master = self.start(Master())
        master.proxy.setParam('test', NAMESPACE, {'record': True, 'bag_directory': str(self.directory)})
        emulator = self.start(Emulator(ROS_MASTER_URI=master.uri))
        known = wait_until(lambda: self.state_of(master.proxy), 'the emulator is registered')
        master.stop(signal.SIGKILL)
        again = self.start(Master(master.port))
        wait_until(lambda: self.state_of(again.proxy) == known, 'registered again, with all topics and services')
        self.assertEqual(emulator.stop(), 0)
        self.assertIn('forgotten', emulator.output())
        path, = self.directory.iterdir()
        checks.assert_identical(self, str(path))

    def state_of(self, master):
        """What the master knows of the emulator, once it is all there."""
        publishers, subscribers, services = master.getSystemState('test')[2]
        ours = [sorted(name for name, nodes in part if NAMESPACE in nodes) for part in (publishers, subscribers, services)]
        complete = {NAMESPACE + '/' + name for name in TOPICS} <= set(ours[0]) and NAMESPACE + '/drag_velocity' in ours[1]
        wanted = ('reset', 'pause', 'step', 'start_recording', 'stop_recording', 'set_parameters', 'get_loggers', 'set_logger_level')
        if not complete or not {NAMESPACE + '/' + name for name in wanted} <= set(ours[2]):
            return None
        code, text, uri = master.lookupNode('test', NAMESPACE)
        self.assertEqual(code, 1, text)
        types = {name: kind for name, kind in master.getTopicTypes('test')[2] if name in ours[0]}
        return ours, uri, types, [master.lookupService('test', name)[2] for name in ours[2]]

    def test_a_subscriber_is_killed_in_the_middle_of_a_message(self):
        emulator = self.recording_emulator()
        for name in ('deflection', 'impacts', 'friction'):
            victim = BareSubscriber(name)
            victim.read_half_a_message()
            victim.die()
        self.deflection.wait_for_more(20)
        self.assert_no_sample_lost()
        self.assertEqual(self.status.wait_for_next().dropped_messages, 0)
        self.end(emulator)

    def test_the_wall_clock_jumps(self):
        library = Path(roslib.packages.find_node(PACKAGE, 'emulator_node')[0]).parents[1] / 'libafm_clock_jump.so'
        jump = Path(self.temporary_directory()) / 'jump'
        jump.write_bytes(struct.pack('d', 0.0))
        emulator = self.recording_emulator(LD_PRELOAD=str(library), CLOCK_JUMP=str(jump))
        for hours in (1, -2, 24 * 365):
            with open(str(jump), 'r+b') as file:
                file.write(struct.pack('d', 3600.0 * hours))
            jumped = self.status.wait_for_next(
                lambda m, h=hours: abs(m.header.stamp.to_sec() - time.time() - 3600 * h) < 60, 'stamps of the new time')
            self.assert_keeps_up()
            self.assertLess(jumped.worst_lag, 5.0)
        self.assertTrue(emulator.call('pause', SetBool, data=True).success)
        with open(str(jump), 'r+b') as file:
            file.write(struct.pack('d', -3600.0))
        self.status.wait_for_next(lambda m: m.paused, 'paused')
        self.status.wait_for_more(5)
        self.assertTrue(emulator.call('pause', SetBool, data=False).success)
        self.assert_keeps_up()
        self.assert_no_sample_lost()
        self.end(emulator)

    def test_use_sim_time_without_a_clock(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        emulator = self.recording_emulator()
        self.assertLess(abs(self.status.wait_for_next().header.stamp.to_sec() - time.time()), 60.0)
        Topic('/diagnostics', DiagnosticArray).wait_for(
            lambda m: any(s.name == 'afm: emulation' for s in m.status), 'diagnostics')
        self.assertTrue(emulator.call('reset', Trigger).success)
        self.assert_keeps_up()
        self.end(emulator)

    def stop_for(self, emulator, seconds):
        emulator.child.send_signal(signal.SIGSTOP)
        end = time.monotonic() + seconds
        wait_until(lambda: time.monotonic() >= end, 'stopped for a while')
        before = self.deflection.messages[-1]
        emulator.child.send_signal(signal.SIGCONT)
        self.deflection.wait_for_next(
            lambda m: m.time.tau - before.time.tau > seconds * MODEL_RATE, 'all that time made up for')
        status = self.status.wait_for_next(lambda m: m.lag < 0.5, 'no longer late')
        self.assertGreater(status.worst_lag, 0.9 * seconds)  # it says so
        self.assertGreater(status.late_batches, 0)

    def test_stopped_and_continued(self):
        emulator = self.recording_emulator()
        self.stop_for(emulator, 1.0)
        self.stop_for(emulator, 4.0)  # more than the queue to the publishing thread holds
        self.assertEqual(self.status.wait_for_next().dropped_messages, 0)
        self.end(emulator)

    def test_parameters_of_an_earlier_run(self):
        set_parameters({'drag_velocity': 5.0e-6, 'no_longer_known': 1})
        self.launch('emulator.launch')
        self.assertAlmostEqual(Topic('configuration').wait_for().drag_velocity, 1.1255437575458838e-05, delta=1e-18)
        self.assertFalse(rospy.has_param(NAMESPACE + '/no_longer_known'))

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


if __name__ == '__main__':
    run(Faults)

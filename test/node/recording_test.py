"""What is recorded is what was published, message for message, also where the emulator is killed. recorder_test.cpp
tests what the recorder refuses, and how a recording ends by itself."""
import itertools
import math
import os
import resource
import shutil
import signal
import subprocess
from pathlib import Path

import rosbag
from afm_emulator.msg import Friction
from afm_emulator.srv import StartRecording, Step
from std_srvs.srv import SetBool, Trigger

import bags
import checks
from emulator_under_test import SPEED_UNIT, Emulator, NodeTest, Process, find, set_parameters
from topics import Topic, wait_until

CHUNK_BYTES = 768 * 1024  # what rosbag writes at once


class Recording(NodeTest):
    def assert_holds(self, recorded, published, begin, end):
        """The recorded messages are one piece of the published ones, and contain those from begin to end."""
        self.assertTrue(recorded)
        wait_until(lambda: recorded[-1] in published.raw, published.name + ': was all published')
        first = published.raw.index(recorded[0])  # each has a number of its own
        self.assertEqual(published.raw[first:first + len(recorded)], recorded, published.name)
        self.assertLessEqual(first, begin, published.name)
        self.assertGreaterEqual(first + len(recorded), end, published.name)

    def test_records_what_is_published(self):
        emulator = self.record()
        published = bags.listen()
        published['deflection'].wait_for_more(10)
        answer = emulator.call('start_recording', StartRecording, name='run.bag')
        self.assertTrue(answer.success, answer.message)
        published['status'].wait_for_next(lambda m: m.recording == answer.path, 'recording')
        # all that is published from now on must be in the bag, but what comes in first may be older
        published['deflection'].wait_for_more(50)
        begin = bags.count(published)
        emulator.drag(6.6e-6)
        published['applied'].wait_for(lambda m: m.drag_velocity == 6.6e-6, 'the command')
        published['deflection'].wait_for_more(150)
        end = bags.count(published)
        self.assertTrue(emulator.call('stop_recording', Trigger).success)
        self.assertEqual([path.name for path in self.directory.iterdir()], ['run.bag'])
        checks.assert_identical(self, answer.path)
        for name, recorded in bags.read(answer.path, raw=True).items():
            self.assert_holds(recorded, published[name], begin[name], end[name])
        with rosbag.Bag(answer.path) as bag:
            first = [topic for topic, _, _ in itertools.islice(bag.read_messages(), 3)]
        self.assertEqual([bags.short(topic) for topic in first], list(bags.BEGINNING))
        status = published['status'].wait_for_next(lambda m: not m.recording, 'no longer recording')
        self.assertEqual(status.recorder_error, '')
        self.end(emulator)

    def assert_repeats_up_to_a_batch_of_no_length(self, path):
        """As a part of a split recording may end: its last batch has what is due before the snapshot."""
        part = path.replace('.bag', '_part.bag')
        with rosbag.Bag(path) as bag, rosbag.Bag(part, 'w') as cut:
            for topic, message, stamp, header in bag.read_messages(return_connection_header=True):
                is_last = topic.endswith('friction') and message.begin == message.time
                if is_last:
                    message.impact_limit = 0
                cut.write(topic, message, stamp, connection_header=header)
                if is_last:
                    break
        checks.assert_identical(self, part)
        checks.simulated_by_python(part)

    def test_events_at_the_time_of_a_command(self):
        """They are in a batch of no length. bag_to_csv missed a command where the last one came behind such a batch,
        and bag_check an impact where the recording began there."""
        emulator = self.record(model='hammer', pace='lockstep', drag_velocity=0.0)
        emulator.control(0.02)
        emulator.control(0.0, 6e-6)
        emulator.call('step', Step, impacts=1)
        emulator.control(0.0, -3e-6)
        emulator.call('step', Step, tau=1.0)  # to where the surface presses
        for name, velocity in (('late', 6e-6), ('early1', 6e-6), ('early2', -6e-6)):
            emulator.control(0.02, 0.0, 0.0 if name == 'late' else -6e-11)
            early = name != 'late' and emulator.call('start_recording', StartRecording, name=name)
            emulator.control(0.0, velocity)
            for _ in range(1 if early else 2):
                emulator.call('step', Step, impacts=1)
            begun = early or emulator.call('start_recording', StartRecording, name=name)
            emulator.control(3e-3, -0.5 * velocity if early else math.nan)
            self.assertTrue(emulator.call('stop_recording', Trigger).success)
            checks.assert_identical(self, begun.path)
            if name == 'early1':
                self.assert_repeats_up_to_a_batch_of_no_length(begun.path)
            answer = checks.call('bag_to_csv', begun.path, '--topic', 'commands')
            self.assertEqual(answer.code, checks.SOUND, answer.text)
        self.end(emulator)

    def test_a_command_between_events_of_one_time(self):
        """Behind a later snapshot, the batch of no length before the command was taken for one after it."""
        emulator = self.record(pace='lockstep', drag_velocity=0.3 * SPEED_UNIT, split_duration_s=0.1)
        emulator.control(0.01)
        self.assertTrue(emulator.call('start_recording', StartRecording, name='split').success)
        times = [None]
        while len(times) < 400 and times[-1] not in times[:-1]:
            time = emulator.call('step', Step, impacts=1).time
            times.append((time.tau, time.phase))
        self.assertIn(times[-1], times[:-1])
        emulator.control(0.0, 0.6 * SPEED_UNIT)
        wait_until(lambda: emulator.control(3e-3) and list(self.directory.glob('split_001*')), 'a part')
        emulator.control(3e-3)
        self.assertTrue(emulator.call('stop_recording', Trigger).success)
        checks.assert_identical(self, *sorted(self.directory.glob('split*.bag')))
        self.end(emulator)

    def test_an_epoch_that_begins_with_an_event(self):
        """It is in a batch of no length before the snapshot, and in the sums of this."""
        emulator = self.record(record=True, pace='lockstep', drag_velocity=3.4 * SPEED_UNIT, contact_tolerance=0.01,
                               rest_height_m=-7.8e-11, initial_phase=0.5, initial_height=-0.09615384615384616,
                               initial_w=5e-5)
        for _ in range(2):
            for _ in range(3):
                emulator.control(0.01)
            self.assertTrue(emulator.call('reset', Trigger).success)
        emulator.control(0.01)
        path, = self.end(emulator)
        checks.assert_identical(self, path)
        for run in checks.simulated_by_python(path):
            self.assertGreater(len(run.vertical), 0)

    def test_recordings_that_begin_late(self):
        """After most of what their estimate of friction counts, or with hardly a sample."""
        emulator, deflection = self.record(), Topic('deflection')
        deflection.wait_for_more(50)
        emulator.drag(0.0)
        Topic('applied').wait_for(lambda m: m.drag_velocity == 0.0, 'the command')
        deflection.wait_for_more(50)
        paths = [emulator.call('start_recording', StartRecording, name='stop').path]
        deflection.wait_for_more(30)
        self.assertTrue(emulator.call('stop_recording', Trigger).success)
        emulator.drag(6.6e-6)
        deflection.wait_for_more(30)
        self.assertTrue(emulator.call('pause', SetBool, data=True).success)
        for i in range(3):
            paths.append(emulator.call('start_recording', StartRecording, name='step%d' % i).path)
            self.assertTrue(emulator.call('step', Step, impacts=1).success)
            self.assertTrue(emulator.call('stop_recording', Trigger).success)
        self.assertTrue(emulator.call('reset', Trigger).success)  # it publishes a snapshot that no recording holds
        paths.append(emulator.call('start_recording', StartRecording, name='after').path)
        self.assertTrue(emulator.call('step', Step, impacts=1).success)
        self.assertTrue(emulator.call('stop_recording', Trigger).success)
        self.end(emulator)
        for path in paths:
            checks.assert_identical(self, path)
        checks.assert_identical(self, *paths[1:-1])  # the status goes on between them
        checks.assert_identical(self, *paths[-2:])  # two recordings: no batch lies between them, but more than batches

    def test_under_way_and_killed(self):
        """The first is read from a copy: to reindex what is written would destroy the rest."""
        emulator, deflection = self.record(record=True), Topic('deflection')
        deflection.wait_for(lambda m: m.first_sample > 300000, 'one and a half seconds')
        active, = self.directory.iterdir()
        self.assertTrue(active.name.endswith('.bag.active'))
        answer = checks.replay_check(active)
        self.assertEqual(answer.code, checks.UNCHECKED, answer.text)
        self.assertRegex(answer.text, 'rosbag reindex .*take a copy while it is written')
        copy = self.directory / 'copy.bag'
        shutil.copy(str(active), str(copy))
        subprocess.run(['rosbag', 'reindex', str(copy)], check=True, stdout=subprocess.DEVNULL)
        checks.assert_identical(self, copy)
        deflection.wait_for_more(50)
        emulator.stop(signal.SIGKILL)
        seen = deflection.messages[-1].first_sample
        subprocess.run(['rosbag', 'reindex', str(active)], check=True, stdout=subprocess.DEVNULL)
        checks.assert_identical(self, active)
        lost = seen - bags.read(str(active))['deflection'][-1].first_sample
        self.assertLess(16 * lost, 2 * CHUNK_BYTES)

    def test_a_file_that_may_grow_no_further(self):
        """The signal that tells of it ended the emulator."""
        emulator, status = self.record(sample_rate_hz=1e6), Topic('status')
        resource.prlimit(emulator.child.pid, resource.RLIMIT_FSIZE, (1 << 22, resource.RLIM_INFINITY))
        self.assertTrue(emulator.call('start_recording', StartRecording, name='large').success)
        error = status.wait_for(lambda m: m.recorder_error, 'the recording has ended').recorder_error
        self.assertIn('large.bag', error)
        resource.prlimit(emulator.child.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)
        self.assertTrue(emulator.call('start_recording', StartRecording, name='next').success)
        Topic('deflection').wait_for_more(50)
        self.assertTrue(emulator.call('stop_recording', Trigger).success)
        emulator.stop()
        checks.assert_identical(self, self.directory / 'next.bag')

    def test_asked_to_record_where_it_cannot(self):
        emulator = self.start(Emulator({'record': True, 'bag_directory': '/dev/null/bags'}))
        self.assertEqual(emulator.wait(), 1)
        self.assertIn('/dev/null', emulator.output())

    def test_a_terminal_that_is_closed_leaves_a_good_bag(self):
        """Under nohup it goes on."""
        for handler, goes_on in ((signal.SIG_DFL, False), (signal.SIG_IGN, True)):
            directory, deflection = Path(self.temporary_directory()), Topic('deflection')
            set_parameters({'record': True, 'bag_directory': str(directory)})
            node = self.start(Process([find('emulator_node'), '__name:=afm'],
                                      preexec_fn=lambda h=handler: signal.signal(signal.SIGHUP, h)))
            deflection.wait_for_more(20)
            node.child.send_signal(signal.SIGHUP)
            if goes_on:
                deflection.wait_for_more(50)
                node.child.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(), 0)
            path, = directory.iterdir()
            checks.assert_identical(self, path)
            Topic.close_all()

    def test_topics_may_be_remapped_and_sigterm_leaves_a_good_bag(self):
        directory = self.temporary_directory()
        set_parameters({'record': True, 'bag_directory': directory})
        node = self.start(Process([find('emulator_node'), '__name:=afm', '~friction:=/force', '~snapshot:=/start']))
        force = Topic('/force', Friction)
        force.wait_for_more(100)
        # as SIGINT, with which the other recordings end: roscpp handles only that by itself
        self.assertEqual(node.stop(signal.SIGTERM), 0)
        path, = (os.path.join(directory, name) for name in os.listdir(directory))
        checks.assert_identical(self, path)
        answer = checks.call('bag_to_csv', path, '--topic', 'friction')
        self.assertEqual(answer.code, 0, answer.text)
        self.assertGreater(len(answer.text.splitlines()) - 1, force.messages[-1].header.seq)  # all that was published

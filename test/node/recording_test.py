#!/usr/bin/python3
"""What is recorded is what was published, message for message. recorder_test.cpp tests what the recorder refuses."""
import itertools
import os

import roslib.packages
import rosbag
from afm_emulator.msg import Friction
from afm_emulator.srv import StartRecording
from std_srvs.srv import Trigger

import bags
import checks
from emulator_under_test import PACKAGE, Emulator, NodeTest, Process, run, set_parameters
from topics import Topic, wait_until


def position(sequence, part):
    """Where `part` begins in `sequence`, as one piece; None if it is not in it."""
    starts = [i for i, item in enumerate(sequence) if item == part[0]]
    return next((i for i in starts if sequence[i:i + len(part)] == part), None)


class Recording(NodeTest):
    def setUp(self):
        super().setUp()
        self.directory = self.temporary_directory()
        self.emulator = self.start(Emulator({'bag_directory': self.directory}))

    def tearDown(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)

    def begin(self, name=''):
        return self.emulator.call('start_recording', StartRecording, name=name)

    def end(self):
        return self.emulator.call('stop_recording', Trigger)

    def assert_holds(self, recorded, published, begin, end):
        """The recorded messages are one piece of the published ones, and contain those from begin to end."""
        self.assertTrue(recorded)
        wait_until(lambda: position(published.raw, recorded) is not None, published.name + ': was all published')
        first = position(published.raw, recorded)
        self.assertLessEqual(first, begin, published.name)
        self.assertGreaterEqual(first + len(recorded), end, published.name)

    def test_records_what_is_published(self):
        published = bags.listen()
        published['deflection'].wait_for_more(10)
        answer = self.begin('run.bag')
        self.assertTrue(answer.success, answer.message)
        published['status'].wait_for_next(lambda m: m.recording == answer.path, 'recording')
        # all that is published from now on must be in the bag, but what comes in first may be older
        published['deflection'].wait_for_more(50)
        begin = bags.count(published)
        self.emulator.drag(6.6e-6)
        published['applied'].wait_for(lambda m: m.drag_velocity == 6.6e-6, 'the command')
        published['deflection'].wait_for_more(150)
        end = bags.count(published)
        self.assertTrue(self.end().success)
        self.assertEqual(os.listdir(self.directory), ['run.bag'])
        bags.assert_sound(self, answer.path)
        for name, recorded in bags.read_raw(answer.path).items():
            self.assert_holds(recorded, published[name], begin[name], end[name])
        with rosbag.Bag(answer.path) as bag:
            first = [topic for topic, _, _ in itertools.islice(bag.read_messages(), 3)]
        self.assertEqual([bags.short(topic) for topic in first], list(bags.BEGINNING))
        status = published['status'].wait_for_next(lambda m: not m.recording, 'no longer recording')
        self.assertEqual(status.recorder_error, '')


class OtherNames(NodeTest):
    def test_topics_may_be_remapped(self):
        directory = self.temporary_directory()
        set_parameters({'record': True, 'bag_directory': directory})
        node = self.start(Process([roslib.packages.find_node(PACKAGE, 'emulator_node')[0], '__name:=afm',
                                   '~friction:=/force', '~snapshot:=/start']))
        Topic('/force', Friction).wait_for_more(100)
        self.assertEqual(node.stop(), 0)
        path, = (os.path.join(directory, name) for name in os.listdir(directory))
        checks.assert_identical(self, path)
        answer = checks.call('bag_to_csv', path, '--topic', 'friction')
        self.assertEqual(answer.code, 0, answer.text)
        self.assertGreater(len(answer.text.splitlines()), 100)


if __name__ == '__main__':
    run(Recording, OtherNames)

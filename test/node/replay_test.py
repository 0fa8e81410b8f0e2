#!/usr/bin/python3
"""replay.launch plays a recorded run to the same topics, message for message, to a subscriber that comes late."""
import os
import time
from pathlib import Path

import rospy

import bags
from emulator_under_test import Emulator, NodeTest, run
from topics import NAMESPACE, TOPICS, Topic, wait_until


class Replay(NodeTest):
    def record(self):
        directory = self.temporary_directory() + "/one's own"
        os.mkdir(directory)
        emulator = self.start(Emulator({'record': True, 'bag_directory': directory}))
        deflection = Topic('deflection')
        deflection.wait_for(lambda m: m.first_sample >= 200000, 'a second of the run')
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        Topic.close_all()
        return str(next(Path(directory).glob('*.bag')))

    def replay(self, topics, **arguments):
        """Returns when all topics are there and a second has passed: to play at once would be noticed."""
        replay = self.launch('replay.launch', **arguments)
        names = {NAMESPACE + '/' + name for name in topics}
        wait_until(lambda: names <= {name for name, _ in rospy.get_published_topics(NAMESPACE)}, 'all topics are there')
        end = time.monotonic() + 1.0
        wait_until(lambda: time.monotonic() > end, 'a second passes')
        return replay

    def assert_played(self, topics, path):
        for topic in topics.values():
            topic.wait_for_connection()
        recorded = bags.read_raw(path)
        for name, topic in topics.items():
            self.assertTrue(recorded[name], name)
            wait_until(lambda: len(topic.raw) >= len(recorded[name]), name + ': played to the end')
            self.assertEqual(topic.raw, recorded[name], name)

    def test_subscribers_have_a_moment_to_come(self):
        path = self.record()
        replay = self.replay(TOPICS, bag=path, delay=5)
        self.assert_played(bags.listen(), path)
        self.assertEqual(replay.wait(), 0)

    def test_waits_for_subscribers_when_asked_to(self):
        path = self.record()
        played = [name for name in TOPICS if name != 'snapshot']
        replay = self.replay(played, bag=path, delay=0, wait='true')
        self.assert_played({name: Topic(name) for name in played}, path)
        self.assertEqual(replay.wait(), 0)


if __name__ == '__main__':
    run(Replay)

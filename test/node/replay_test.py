#!/usr/bin/python3
"""replay.launch plays a recorded run to the same topics, message for message, to a subscriber that comes late."""
from pathlib import Path

import rospy

import bags
from emulator_under_test import Emulator, NodeTest, run
from topics import NAMESPACE, TOPICS, Topic, wait_until


class Replay(NodeTest):
    def record(self):
        directory = self.temporary_directory()
        emulator = self.start(Emulator({'record': True, 'bag_directory': directory}))
        deflection = Topic('deflection')
        deflection.wait_for(lambda m: m.first_sample >= 200000, 'a second of the run')
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        Topic.close_all()
        return str(next(Path(directory).glob('*.bag')))

    def wait_for_topics(self):
        names = {NAMESPACE + '/' + name for name in TOPICS}
        wait_until(lambda: names <= {name for name, _ in rospy.get_published_topics(NAMESPACE)}, 'all topics are there')

    def assert_plays(self, path):
        recorded, replayed = bags.read_raw(path), bags.listen()
        for name, topic in replayed.items():
            self.assertTrue(recorded[name], name)
            wait_until(lambda: len(topic.raw) >= len(recorded[name]), name + ': played to the end')
            self.assertEqual(topic.raw, recorded[name], name)

    def test_subscribers_have_a_moment_to_come(self):
        path = self.record()
        replay = self.launch('replay.launch', bag=path)
        self.wait_for_topics()
        self.assert_plays(path)
        self.assertEqual(replay.wait(), 0)

    def test_waits_for_subscribers_when_asked_to(self):
        path = self.record()
        replay = self.launch('replay.launch', bag=path, wait='true', delay='0.1')
        self.wait_for_topics()
        self.assert_plays(path)
        self.assertEqual(replay.wait(), 0)


if __name__ == '__main__':
    run(Replay)

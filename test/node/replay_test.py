"""replay.launch plays a recorded run to the same topics, message for message, to a subscriber that comes late."""
import os
import time

import rospy

import bags
from emulator_under_test import NodeTest
from topics import NAMESPACE, TOPICS, Topic, wait_until


class Replay(NodeTest):
    def setUp(self):
        super().setUp()
        emulator = self.record(record=True)
        Topic('deflection').wait_for(lambda m: m.first_sample >= 200000, 'part of a run')
        bag, = self.end(emulator)
        self.path = os.path.join(os.path.dirname(bag), "one's own.bag")
        os.rename(bag, self.path)
        Topic.close_all()

    def test_subscribers_have_a_moment_to_come(self):
        replay = self.launch('replay.launch', bag=self.path, delay=10)
        names = {NAMESPACE + '/' + name for name in TOPICS}
        wait_until(lambda: names <= {name for name, _ in rospy.get_published_topics(NAMESPACE)}, 'all topics are there')
        end = time.monotonic() + 1.0  # to play at once would be noticed
        wait_until(lambda: time.monotonic() > end, 'a second passes')
        topics = bags.listen()
        recorded = bags.read(self.path, raw=True)
        for name, topic in topics.items():
            self.assertTrue(recorded[name], name)
            wait_until(lambda: len(topic.raw) >= len(recorded[name]), name + ': played to the end')
            self.assertEqual(topic.raw, recorded[name], name)
        self.assertEqual(replay.wait(), 0)

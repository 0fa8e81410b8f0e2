#!/usr/bin/python3
"""emulator.launch starts a node that publishes everything, as fast as time passes."""
import time
import unittest
from fractions import Fraction

from emulator_under_test import TAU_S, pid_of_node, run
from topics import TOPICS, Topic, tau_between, wait_until


class Publishes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arrival, topics = [], {name: Topic(name) for name in TOPICS}
        topics['deflection'].wait_for()
        cls.pid = pid_of_node()
        cls.wait_for_real_time(topics['deflection'])
        # what was late on a busy machine is caught up first
        topics['status'].wait_for_next(lambda m: abs(m.real_time_factor - 1.0) < 0.05, 'real time')
        cls.topics = {name: topic.messages for name, topic in topics.items()}
        Topic.close_all()

    @classmethod
    def tearDownClass(cls):
        before = Topic('deflection').wait_for()
        Topic('deflection').wait_for(lambda m: m.first_sample > before.first_sample, 'still counting')
        assert pid_of_node() == cls.pid, 'the node was started anew'

    @staticmethod
    def wait_for_real_time(deflection):
        """A second in which model time goes as wall time does: a busy machine holds it up, and then it catches up."""
        begin = (time.monotonic(), deflection.messages[-1].time)

        def goes_along():
            nonlocal begin
            end = (time.monotonic(), deflection.messages[-1].time)
            if end[0] - begin[0] < 1.0:
                return False
            ratio = tau_between(begin[1], end[1]) * TAU_S / (end[0] - begin[0])
            begin = end
            return abs(ratio - 1.0) < 0.05
        wait_until(goes_along, 'model time goes as wall time does', deadline_s=60.0)

    def configuration(self):
        return self.topics['configuration'][-1]

    def test_every_topic_speaks(self):
        for name, messages in self.topics.items():
            self.assertTrue(messages, name)
            for message in messages:
                self.assertGreater(message.header.stamp.to_sec(), 0.0, name)

    def test_batches_tell_their_exact_time(self):
        period = Fraction(self.configuration().sample_period_tau)
        for message in self.topics['deflection']:
            reported = message.time.tau + Fraction(message.time.phase)
            self.assertLess(abs(reported - message.first_sample * period), Fraction('1e-9'))
            self.assertEqual(message.sample_period, self.configuration().sample_period)
            self.assertEqual(len(message.vertical), self.configuration().samples_per_batch)


if __name__ == '__main__':
    run(Publishes)

#!/usr/bin/python3
"""emulator.launch starts a node that publishes everything, without a gap, as fast as time passes."""
import time
import unittest
from fractions import Fraction

from emulator_under_test import TAU_S, pid_of_node, run
from topics import TOPICS, Topic, tau_between, wait_until


def batch_indices(messages, first, content):
    return [(getattr(m, first), len(getattr(m, content))) for m in messages]


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

    def assert_no_gap(self, name, first, content):
        messages = batch_indices(self.topics[name], first, content)
        self.assertGreater(len(messages), 10)
        for (index, length), (following, _) in zip(messages, messages[1:]):
            self.assertEqual(index + length, following)

    def test_every_topic_speaks(self):
        for name, messages in self.topics.items():
            self.assertTrue(messages, name)
            for message in messages:
                self.assertGreater(message.header.stamp.to_sec(), 0.0, name)

    def test_batches_hold_their_samples(self):
        samples = round(self.configuration().sample_rate_hz / self.configuration().batch_rate_hz)
        self.assertEqual(self.configuration().samples_per_batch, samples)
        for message in self.topics['deflection']:
            self.assertEqual((len(message.vertical), len(message.lateral)), (samples, samples))

    def test_no_sample_and_no_impact_is_lost(self):
        self.assert_no_gap('deflection', 'first_sample', 'vertical')
        self.assert_no_gap('impacts', 'first_index', 'impacts')

    def test_batches_tell_their_exact_time(self):
        period = Fraction(self.configuration().sample_period_tau)
        for message in self.topics['deflection']:
            reported = message.time.tau + Fraction(message.time.phase)
            self.assertLess(abs(reported - message.first_sample * period), Fraction('1e-9'))
            self.assertEqual(message.sample_period, self.configuration().sample_period)

    def test_impacts_are_ordered_and_within_their_batch(self):
        impacts = [impact for message in self.topics['impacts'] for impact in message.impacts]
        self.assertGreater(len(impacts), 1000)
        for impact, following in zip(impacts, impacts[1:]):
            self.assertGreaterEqual(tau_between(impact.time, following.time), 0.0)
        for impact in impacts:
            self.assertTrue(0.0 <= impact.surface_phase < 1.0 and 0.0 <= impact.time.phase < 1.0)
            self.assertTrue(impact.energy_loss >= 0.0 and impact.normal_speed >= 0.0)

    def test_deflection_is_of_the_surface_size(self):
        heights = [y for message in self.topics['deflection'] for y in message.vertical]
        self.assertGreater(min(heights), -0.06e-9)
        self.assertTrue(0.05e-9 < max(heights) < 10e-9, max(heights))

    def test_the_lateral_force_is_the_friction_but_for_what_the_tip_stores(self):
        last = self.topics['friction'][-1]
        self.assertGreater(last.mean_lateral_force_std_error, 0.0)
        self.assertLess(abs(last.mean_lateral_force - last.force),
                        5 * (last.mean_lateral_force_std_error + last.force_std_error))

    def test_nothing_that_must_stay_zero_has_happened(self):
        status = self.topics['status'][-1]
        self.assertEqual((status.search_failures, status.refused_commands, status.dropped_messages), (0, 0, 0))
        self.assertLess(status.worst_penetration, 1e-20)



if __name__ == '__main__':
    run(Publishes)

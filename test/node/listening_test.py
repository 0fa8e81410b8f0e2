#!/usr/bin/python3
"""The deflection is sampled while someone listens or records, and who comes late finds it as if it always had been."""
from fractions import Fraction

from afm_emulator.srv import StartRecording, Step
from std_srvs.srv import SetBool, Trigger

import bags
from checks import assert_identical
from emulator_under_test import TAU_S, EmulatorTest, run
from topics import Topic, tau_between, wait_until


class Listening(EmulatorTest):
    def setUp(self):
        self.parameters = {'bag_directory': self.temporary_directory(), 'batch_rate_hz': 250.0}
        super().setUp()
        self.digest = Topic('digest')

    def wait_unheard(self):
        """A second of the run in which nobody asked for samples."""
        return self.digest.wait_for_next(lambda m: m.samples > 0 and m.first_sample == m.samples, 'unheard')

    def assert_gapless(self, deflection):
        for message, following in zip(deflection.messages, deflection.messages[1:]):
            self.assertEqual(message.first_sample + len(message.vertical), following.first_sample)
            self.assertEqual(message.header.seq + 1, following.header.seq)

    def test_who_comes_late_finds_samples_at_their_indices(self):
        unheard = self.wait_unheard()
        seen = unheard.samples
        friction = Topic('friction')
        for _ in range(2):  # comes, goes, and comes again
            deflection = Topic('deflection')
            deflection.wait_for_more(20)
            first = deflection.messages[0]
            self.assertGreaterEqual(first.first_sample, seen)
            period = 1 / (200000 * TAU_S)
            reported = tau_between(unheard.time, first.time)
            self.assertAlmostEqual(reported, (first.first_sample - unheard.samples) * period, delta=1e-6)
            self.assertEqual({len(m.vertical) for m in deflection.messages}, {800})
            self.assert_gapless(deflection)
            seen = deflection.messages[-1].first_sample + 800
            deflection.close()
            self.wait_unheard()
        same = friction.wait_for(lambda m: m.header.seq == first.header.seq, 'of the same batch')
        self.assertEqual(same.header.stamp, first.header.stamp)
        last = Fraction(first.time.tau) + Fraction(first.time.phase)
        self.assertGreaterEqual(Fraction(same.time.tau) + Fraction(same.time.phase), last)

    def test_a_recording_begun_when_nobody_listened_is_whole(self):
        self.wait_unheard()
        for name in 'one', 'two':  # between them nobody listens again
            reply = self.emulator.call('start_recording', StartRecording, name=name)
            self.assertTrue(reply.success, reply.message)
            self.digest.wait_for_next(lambda m: m.first_sample < m.samples, 'samples are covered')
            self.digest.wait_for_next()
            self.assertTrue(self.emulator.call('stop_recording', Trigger).success)
            bags.assert_sound(self, reply.path)
            assert_identical(self, reply.path)
            self.wait_unheard()

    def test_a_step_is_sampled_for_one_who_came_in_the_pause(self):
        self.wait_unheard()
        self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
        deflection = Topic('deflection')
        deflection.wait_for_connection()
        self.assertTrue(self.emulator.call('step', Step, tau=50.0, impacts=0).success)
        due = 50.0 * TAU_S * 200000  # in two batches, each a message of its own

        def taken():
            return sum(len(m.vertical) for m in list(deflection.messages))
        wait_until(lambda: taken() >= due - 1, 'every sample of the step')
        self.assert_gapless(deflection)
        self.assertAlmostEqual(taken(), due, delta=1)


if __name__ == '__main__':
    run(Listening)

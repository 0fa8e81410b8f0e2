#!/usr/bin/python3
"""The drag speeds at which other methods stall: rest, crawling, chatter, the glide, both ways. Model time keeps up with the wall
clock, and everything that must stay zero does."""
from emulator_under_test import SPEED_UNIT, EmulatorTest, run
from topics import Topic, tau_between

ETAS = (0.0, 0.2, 0.34, 1.0, 3.0, 5.0, -3.4, 1e-4)
EACH_TAU = 6400  # about a second
LATTICE_M = 0.52e-9


class DragSpeeds(EmulatorTest):
    def assert_counters(self, status):
        for counter in ('budget_exhausted', 'search_failures', 'refused_commands'):
            self.assertEqual(getattr(status, counter), 0, counter)
        self.assertLessEqual(status.worst_penetration, 1e-15 * LATTICE_M)

    def test_none_stalls(self):
        status, applied, friction = Topic('status'), Topic('applied_drag'), Topic('friction')
        for eta in ETAS:
            self.emulator.drag(eta * SPEED_UNIT)
            begin = applied.wait_for_next(lambda m: m.drag_velocity == eta * SPEED_UNIT, 'eta = %g' % eta).time
            later = status.wait_for_next(lambda m: tau_between(begin, m.time) > EACH_TAU, 'time goes on at eta = %g' % eta)
            self.assert_counters(later)
            reported = friction.wait_for_next(lambda m: m.drag_velocity == eta * SPEED_UNIT, 'friction at eta = %g' % eta)
            self.assertAlmostEqual(reported.eta, eta, delta=1e-12)
        # a busy machine may hold it up for a while: it catches up
        self.assert_counters(status.wait_for_next(lambda m: m.real_time_factor > 0.99, 'real time'))


if __name__ == '__main__':
    run(DragSpeeds)

#!/usr/bin/python3
"""At drag velocity 0 there is no friction coefficient, yet the node goes on, and obeys the next command."""
import math

from emulator_under_test import SPEED_UNIT, EmulatorTest, run
from topics import Topic


class Standstill(EmulatorTest):
    parameters = {'drag_velocity': 0.0}

    def assert_no_friction(self):
        friction = self.friction.wait_for_next(lambda m: m.drag_velocity == 0.0, 'standing')
        self.assertEqual((friction.force, friction.eta), (0.0, 0.0))
        for k_f in (friction.k_f, friction.k_f_natural, friction.window_k_f):
            self.assertTrue(math.isnan(k_f))

    def assert_publishes(self, batches=20):
        now = self.deflection.wait_for_next()
        later = self.deflection.wait_for(
            lambda m: m.first_sample >= now.first_sample + batches * len(now.vertical), 'batches go on')
        self.assertTrue(all(map(math.isfinite, later.vertical + later.lateral)))

    def assert_wakes_up(self):
        self.emulator.drag(2.0 * SPEED_UNIT)
        friction = self.friction.wait_for_next(lambda m: m.impact_count > 100 and m.drag_velocity > 0.0, 'moving')
        self.assertGreater(friction.force, 0.0)
        self.assertGreater(friction.k_f, 0.0)
        self.assert_publishes()

    def test_stands_and_wakes_up_twice(self):
        self.friction, self.deflection = Topic('friction'), Topic('deflection')
        self.assert_no_friction()
        self.assert_publishes()
        self.assert_wakes_up()
        self.emulator.drag(0.0)
        self.assert_no_friction()
        self.assert_publishes()
        self.assert_wakes_up()


if __name__ == '__main__':
    run(Standstill)

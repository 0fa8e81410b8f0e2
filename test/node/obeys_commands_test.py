#!/usr/bin/python3
"""A drag command takes effect at a model time that is reported, and the friction is the one known for that speed."""
import math

from emulator_under_test import FRICTION_UNIT, SPEED_UNIT, EmulatorTest, run
from topics import Topic, key, tau_between

SLOPE = 2 * math.pi * 0.05 / 0.52
K_F_AT_PEAK = 4 * (1 + 0.7) / (1 - 0.7) * SLOPE**2 / (1 + SLOPE**2)  # closed form at even eta [m_tip/tau]
K_F_AT_3_4 = 0.2533                                                  # of the chaotic attractor [m_tip/tau]
SETTLED_TAU = 10000


class ObeysCommands(EmulatorTest):
    def setUp(self):
        super().setUp()
        self.applied, self.friction, self.deflection = Topic('applied_drag'), Topic('friction'), Topic('deflection')
        self.deflection.wait_for()

    def command(self, eta):
        self.emulator.drag(eta * SPEED_UNIT)
        return self.applied.wait_for(lambda m: m.drag_velocity == eta * SPEED_UNIT, 'eta = %g' % eta)

    def settled_friction(self, eta):
        applied = self.command(eta)
        return self.friction.wait_for(lambda m: m.drag_velocity == applied.drag_velocity
                                      and tau_between(applied.time, m.time) > SETTLED_TAU, 'settled')

    def assert_friction(self, eta, expected, tolerance):
        friction = self.settled_friction(eta)
        window = friction.window_k_f / FRICTION_UNIT
        for k_f in (friction.k_f_natural, friction.k_f / FRICTION_UNIT):
            self.assertAlmostEqual(k_f / expected, 1.0, delta=tolerance)
        self.assertAlmostEqual(window / expected, 1.0, delta=5 * tolerance)
        self.assertAlmostEqual(friction.eta, eta, delta=1e-12)
        self.assertAlmostEqual(friction.force / (friction.k_f * friction.drag_velocity), 1.0, delta=1e-9)
        self.assertGreater(friction.k_f_std_error, 0.0)
        return friction

    def test_takes_effect_at_a_batch_boundary(self):
        applied = self.command(2.0)
        self.deflection.wait_for(lambda m: key(m.time) == key(applied.time), 'a batch begins at the time reported')
        self.friction.wait_for(lambda m: m.drag_velocity == applied.drag_velocity, 'the new speed')
        for friction in list(self.friction.messages):
            # an estimate is reported at the end of a batch: at the boundary itself the old speed held
            old = key(friction.time) <= key(applied.time)
            self.assertEqual(friction.drag_velocity == applied.drag_velocity, not old)

    def test_friction_peaks_at_even_eta(self):
        friction = self.assert_friction(2.0, K_F_AT_PEAK, 0.01)
        self.assertGreater(friction.force, 0.0)

    def test_friction_is_even_in_the_direction(self):
        friction = self.assert_friction(-2.0, K_F_AT_PEAK, 0.01)
        self.assertLess(friction.force, 0.0)

    def test_friction_of_the_chaotic_attractor(self):
        self.assert_friction(3.4, K_F_AT_3_4, 0.05)
        self.assert_friction(-3.4, K_F_AT_3_4, 0.05)


if __name__ == '__main__':
    run(ObeysCommands)

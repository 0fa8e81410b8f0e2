"""Model time goes as wall time does. The friction is the one known for the speed of a drag command. A command that
cannot be is counted and changes nothing. scripts/soak sends thousands, of every size."""
import math
import time

from emulator_under_test import FRICTION_UNIT, TAU_S, EmulatorTest
from topics import tau_between, wait_until

SLOPE = 2 * math.pi * 0.05 / 0.52
K_F_AT_PEAK = 4 * (1 + 0.7) / (1 - 0.7) * SLOPE**2 / (1 + SLOPE**2)  # closed form at even eta [m_tip/tau]
SETTLED_TAU = 10000
MOST = 1e-4  # max_drag_velocity [m/s]
JUNK = [math.nan, math.inf, -math.inf, 1.0000001 * MOST, -1.0000001 * MOST, 1e300, -1e300]


class Commands(EmulatorTest):
    def setUp(self):
        super().setUp()
        self.applied, self.deflection = self.topics['applied'], self.topics['deflection']

    def test_model_time_goes_as_wall_time_does(self):
        """For a second: a busy machine holds it up, and then it catches up."""
        self.deflection.wait_for()
        begin = (time.monotonic(), self.deflection.messages[-1].time)

        def goes_along():
            nonlocal begin
            end = (time.monotonic(), self.deflection.messages[-1].time)
            if end[0] - begin[0] < 1.0:
                return False
            ratio = tau_between(begin[1], end[1]) * TAU_S / (end[0] - begin[0])
            begin = end
            return abs(ratio - 1.0) < 0.05
        wait_until(goes_along, 'a second in real time')
        self.topics['status'].wait_for_next(lambda m: abs(m.real_time_factor - 1.0) < 0.05, 'the status says so')

    def test_friction_peaks_at_even_eta_in_both_directions(self):
        """After long, in every form in which it is reported."""
        for eta in (2.0, -2.0):
            self.begin(paused=True)
            self.drag(eta)
            friction = self.stepped(SETTLED_TAU)
            for k_f in (friction.k_f_natural, friction.k_f_work_natural, friction.k_f / FRICTION_UNIT,
                        friction.k_f_work / FRICTION_UNIT):
                self.assertAlmostEqual(k_f / K_F_AT_PEAK, 1.0, delta=0.01)
            self.assertAlmostEqual(friction.window_k_f_natural / K_F_AT_PEAK, 1.0, delta=0.05)
            self.assertAlmostEqual(friction.window_k_f / FRICTION_UNIT / friction.window_k_f_natural, 1.0, delta=1e-9)
            self.assertAlmostEqual(friction.eta, eta, delta=1e-12)
            self.assertAlmostEqual(friction.force / (friction.k_f * friction.drag_velocity), 1.0, delta=1e-9)
            self.assertEqual(friction.force > 0.0, eta > 0.0)
            self.assertGreater(friction.k_f_std_error, 0.0)

    def test_junk_is_counted_and_changes_nothing(self):
        before = self.status_now().refused_commands
        for velocity in JUNK:
            self.emulator.drag(velocity)
        self.emulator.drag(-MOST)  # the fastest there is; all that came before it has been judged when it is applied
        self.applied.wait_for(lambda m: m.drag_velocity == -MOST, 'the last command')
        self.assertEqual([m.cause for m in self.applied.messages], ['epoch', 'drag_velocity'])
        self.topics['status'].wait_for(lambda m: m.refused_commands >= before + len(JUNK), 'the refused are counted')
        self.assertEqual(self.status_now().refused_commands, before + len(JUNK))

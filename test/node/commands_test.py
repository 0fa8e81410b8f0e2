"""Model time goes as wall time does, and every batch tells its own. A drag command takes effect at a model time that is
reported, and the friction is the one known for that speed. One that cannot be is counted and changes nothing.
scripts/soak sends thousands, of every size."""
import math
import time
from fractions import Fraction

from emulator_under_test import FRICTION_UNIT, SPEED_UNIT, TAU_S, EmulatorTest
from topics import key, tau_between, wait_until

SLOPE = 2 * math.pi * 0.05 / 0.52
K_F_AT_PEAK = 4 * (1 + 0.7) / (1 - 0.7) * SLOPE**2 / (1 + SLOPE**2)  # closed form at even eta [m_tip/tau]
SETTLED_TAU = 10000
MOST = 1e-4  # max_drag_velocity [m/s]
JUNK = [math.nan, math.inf, -math.inf, 1.0000001 * MOST, -1.0000001 * MOST, 1e300, -1e300]
LATTICE_M = 0.52e-9


class Commands(EmulatorTest):
    def setUp(self):
        super().setUp()
        self.applied, self.friction, self.deflection = (self.topics[n] for n in ('applied', 'friction', 'deflection'))

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

    def test_batches_tell_their_exact_time(self):
        self.deflection.wait_for_more(20)
        configuration = self.topics['configuration'].messages[-1]
        period = Fraction(configuration.sample_period_tau)
        for message in list(self.deflection.messages):
            reported = message.time.tau + Fraction(message.time.phase)
            self.assertLess(abs(reported - message.first_sample * period), Fraction('1e-9'))
            self.assertEqual(message.sample_period, configuration.sample_period)
            self.assertEqual(len(message.vertical), configuration.samples_per_batch)
            self.assertGreater(message.header.stamp.to_sec(), 0.0)

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

    def test_takes_effect_at_a_batch_boundary(self):
        applied = self.drag(2.0)
        batch = self.deflection.wait_for(lambda m: key(m.time) == key(applied.time),
                                         'a batch begins at the time reported')
        self.assertEqual((batch.first_sample, batch.drag_velocity), (applied.first_sample, applied.drag_velocity))
        self.friction.wait_for(lambda m: m.drag_velocity == applied.drag_velocity, 'the new speed')
        for friction in list(self.friction.messages):
            self.assertEqual(friction.drag_velocity == applied.drag_velocity, key(friction.begin) >= key(applied.time))

    def test_the_holder_is_where_its_drag_has_brought_it(self):
        applied = self.drag(-1.3)
        self.deflection.wait_for(lambda m: tau_between(applied.time, m.time) > 200, 'goes on')
        start = 0.25 * LATTICE_M
        reached = start + self.applied.messages[0].drag_velocity * tau_between(self.applied.messages[0].time,
                                                                              applied.time) * TAU_S
        for m in list(self.deflection.messages):
            before = key(m.time) < key(applied.time)
            expected = (start + 3.4 * SPEED_UNIT * (m.time.tau + m.time.phase) * TAU_S if before else
                        reached - 1.3 * SPEED_UNIT * tau_between(applied.time, m.time) * TAU_S)
            self.assertAlmostEqual(m.holder_position / LATTICE_M, expected / LATTICE_M, delta=1e-6)

    def test_junk_is_counted_and_changes_nothing(self):
        before = self.status_now().refused_commands
        for velocity in JUNK:
            self.emulator.drag(velocity)
        self.emulator.drag(-MOST)  # the fastest there is; all that came before it has been judged when it is applied
        self.applied.wait_for(lambda m: m.drag_velocity == -MOST, 'the last command')
        self.assertEqual([m.cause for m in self.applied.messages], ['epoch', 'drag_velocity'])
        self.topics['status'].wait_for(lambda m: m.refused_commands >= before + len(JUNK), 'the refused are counted')
        self.assertEqual(self.status_now().refused_commands, before + len(JUNK))

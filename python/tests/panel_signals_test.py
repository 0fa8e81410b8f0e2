#!/usr/bin/python3
"""Signals of the panel, without ROS and without a window. usage: panel_signals_test.py PATH_OF_THE_CLIENT"""
import math
import sys
import unittest
from types import SimpleNamespace

sys.path.insert(0, sys.argv.pop(1))
import numpy as np  # noqa: E402
from afm_emulator.panel.signals import FrictionLoop, Motion, Recent, Scale, Trail, envelope, swing  # noqa: E402

TAU_S, SPACING_M, OMEGA_H = 2 * math.pi / 40e3, 0.52e-9, 2 * math.pi * 6.25
AMPLITUDE = 0.05 / 0.52


class Envelope(unittest.TestCase):
    def test_loses_no_peak(self):
        chance = np.random.default_rng(2)
        for count in (1, 2, 5, 1999, 2000, 31416):
            t, y = np.arange(count, dtype=float), chance.normal(size=count)
            for spike in chance.integers(0, count, 5):
                y[spike] = chance.choice([-50.0, 50.0])
            seen_t, seen = envelope(t, y, 500)
            self.assertLessEqual(len(seen), 1000)
            self.assertEqual((seen.min(), seen.max()), (y.min(), y.max()))
            self.assertTrue(np.all(np.diff(seen_t) >= 0.0))
            np.testing.assert_array_equal(y[seen_t.astype(int)], seen)

    def test_every_bucket_shows_both_of_its_ends(self):
        t, y = np.arange(10000.0), np.random.default_rng(3).normal(size=10000)
        seen_t, seen = envelope(t, y, 100)
        for bucket in range(100):
            here = (seen_t >= 100 * bucket) & (seen_t < 100 * (bucket + 1))
            part = y[100 * bucket:100 * (bucket + 1)]
            self.assertEqual((seen[here].min(), seen[here].max()), (part.min(), part.max()))


class Swing(unittest.TestCase):
    def test_is_exact_on_free_oscillation(self):
        t = np.array([0.0, 0.031, 0.05, 0.081])
        fine = np.append((t[:-1, None] + np.diff(t)[:, None] * np.arange(8) / 8).ravel(), t[-1])
        seen = swing(t, np.cos(OMEGA_H * t + 0.3), OMEGA_H, 8, np.ones(3, bool))
        np.testing.assert_allclose(seen, np.cos(OMEGA_H * fine + 0.3), atol=1e-12)

    def test_is_straight_where_too_little_is_known(self):
        for length, is_free in ((1.0, True), (0.03, False)):
            line = swing(np.array([0.0, length]), np.array([0.0, 4.0]), OMEGA_H, 4, np.array([is_free]))
            np.testing.assert_allclose(line, [0.0, 1.0, 2.0, 3.0, 4.0])


def periodic(eta, duration, period, offset=0.0, rate=200e3, height=0.0):
    """A tip that swings with that period, with the drag speed eta; its holder is so high."""
    t = offset + np.arange(0.0, duration, 1.0 / (rate * TAU_S))
    return np.stack([t, 0.1 * np.cos(2 * np.pi * t / period), 0.01 * np.sin(2 * np.pi * t / period), eta * t + 0.3,
                     np.full(len(t), height)])


NONE = np.empty((4, 0))


class Trigger(unittest.TestCase):
    def picture(self, eta, period, offset):
        motion = Motion(periodic(eta, 25.0, period, offset), NONE, AMPLITUDE, OMEGA_H)
        begin = motion.trigger(5.0, math.copysign(1.0, eta))
        x = motion.xc + motion.X
        self.assertAlmostEqual(math.copysign(1.0, eta) * np.interp(begin, motion.t, x) % 1.0, 0.75, delta=1e-3)
        self.assertLessEqual(begin + 5.0, motion.t[-1])
        return np.interp(begin + np.linspace(0.0, 5.0, 100), motion.t, motion.Y)

    def test_a_periodic_motion_stands_still(self):
        for eta, period in ((2.0, 1.0), (-2.0, 1.0), (3.5, 2.0), (-1.25, 4.0)):
            pictures = [self.picture(eta, period, offset) for offset in (0.0, 0.37, 1.113, 2.71, 5.05)]
            for other in pictures[1:]:
                np.testing.assert_allclose(other, pictures[0], atol=0.004)  # of 0.1

    def test_a_tip_at_rest_triggers_nothing(self):
        self.assertIsNone(Motion(periodic(0.0, 25.0, 1.0), NONE, AMPLITUDE, OMEGA_H).trigger(5.0, 1.0))

    def test_is_in_the_picture_as_a_whole(self):
        self.assertIsNone(Motion(periodic(2.0, 4.0, 1.0), NONE, AMPLITUDE, OMEGA_H).trigger(5.0, 1.0))


class Impacts(unittest.TestCase):
    def test_lie_on_the_path_and_on_the_surface(self):
        samples = periodic(1.0, 2.0, 1.0, height=0.01)
        impacts = np.array([[0.5011], [(0.3 + 0.5011 + 0.02) % 1.0], [1e-21], [0]])
        motion = Motion(samples, impacts, AMPLITUDE, OMEGA_H)
        i = np.argmin(np.abs(motion.t - 0.5011))
        self.assertAlmostEqual(motion.t[i], 0.5011, delta=1e-12)
        self.assertAlmostEqual(motion.X[i], 0.02, delta=1e-12)
        self.assertAlmostEqual(motion.Y[i] + 0.01, AMPLITUDE * math.cos(2 * math.pi * impacts[1, 0]), delta=1e-12)

    def test_from_before_a_change_of_load_lie_where_the_holder_was_then(self):
        """With the height of now they lay far above the surface, or in it."""
        samples = periodic(1.0, 2.0, 1.0, height=0.01)
        samples[4, samples[0] > 1.0] = -1.0
        impacts = np.array([[0.5011, 1.5011], [0.8211, 0.8211], [1e-21, 1e-21], [0, 0]])
        motion = Motion(samples, impacts, AMPLITUDE, OMEGA_H)
        for t, height in ((0.5011, 0.01), (1.5011, -1.0)):
            i = np.argmin(np.abs(motion.t - t))
            self.assertEqual(motion.height[i], height)
            self.assertAlmostEqual(motion.Y[i] + height, AMPLITUDE * math.cos(2 * math.pi * 0.8211), delta=1e-12)

    def test_of_a_soft_lever_lie_whole_cells_behind_the_holder(self):
        samples = periodic(1.0, 2.0, 1.0, height=0.01)
        impacts = np.array([[0.5011], [(0.3 + 0.5011 + 0.02) % 1.0], [1e-21], [0]])
        near = Motion(samples, impacts, AMPLITUDE, OMEGA_H)
        samples[2] -= 2.0
        far = Motion(samples, impacts, AMPLITUDE, OMEGA_H, steps=1)
        self.assertAlmostEqual(far.X[np.argmin(np.abs(far.t - 0.5011))], 0.02 - 2.0, delta=1e-12)
        self.assertLess(np.ptp(far.X), 2.0 * np.ptp(near.X))


class Contact(unittest.TestCase):
    def test_a_tip_in_contact_does_not_fly_from_sample_to_sample(self):
        t = np.arange(0.0, 2.0, 0.05)
        height = -4.0  # a load that would lift a free tip by a tenth of a cell between two samples
        samples = np.stack([t, AMPLITUDE * np.cos(2 * np.pi * t) - height, 0.0 * t, t, 0.0 * t + height])
        motion = Motion(samples, NONE, AMPLITUDE, OMEGA_H)
        gap = motion.Y + height - AMPLITUDE * np.cos(2 * np.pi * (motion.xc + motion.X))
        self.assertLess(np.abs(gap).max(), 2e-3)


def batch(first, count, epoch=0, velocity=0.0):
    period = 5e-6
    t = first * period / TAU_S
    return SimpleNamespace(epoch=epoch, first_sample=first, sample_period=period, drag_velocity=velocity,
                           holder_position=velocity * first * period, lateral=np.zeros(count),
                           time=SimpleNamespace(tau=10**9 + int(t), phase=t % 1.0),
                           vertical=SPACING_M * np.arange(first, first + count))


class RecentBatches(unittest.TestCase):
    def test_hours_in_no_digit_is_lost(self):
        recent = Recent(5000)
        for first in range(0, 20000, 1000):
            recent.add(batch(first, 1000, velocity=1e-5), [])
        t, Y, X, xc, _ = recent.last(1000.0, SPACING_M, TAU_S)[0]
        np.testing.assert_allclose(np.diff(t), 5e-6 / TAU_S, rtol=1e-9)
        np.testing.assert_allclose(Y, np.arange(20000 - len(Y), 20000), rtol=1e-12)
        np.testing.assert_allclose(np.diff(xc), 1e-5 * 5e-6 / SPACING_M, rtol=1e-6)
        self.assertTrue(5000 <= len(t) <= 6000)
        few = recent.last(10.0, SPACING_M, TAU_S)[0]
        self.assertAlmostEqual(few[0, -1] - few[0, 0], 10.0, delta=0.05)
        np.testing.assert_array_equal(few[1], Y[-few.shape[1]:])

    def test_a_gap_or_a_reset_begins_anew(self):
        recent = Recent(5000)
        for first, epoch in ((0, 0), (300, 0), (400, 1)):
            recent.add(batch(first, 100, epoch=epoch), [])
            self.assertEqual(recent.last(1000.0, SPACING_M, TAU_S)[0].shape[1], 100)


    def test_every_batch_has_the_height_of_its_time(self):
        recent = Recent(5000)
        for since, height in (((0, 0), 0.0), ((0, 200), -1e-9), ((1, 0), 2e-9), ((0, 0), 3e-9)):  # another emulator
            recent.change(SimpleNamespace(epoch=since[0], first_sample=since[1], rest_height_m=height))
            for first in (0, 100, 200, 300):
                recent.add(batch(first, 100), [])
            heights = recent.last(1000.0, SPACING_M, TAU_S)[0][4, ::100] * SPACING_M
            expected = {0.0: [0, 0, 0, 0], -1e-9: [0, 0, -1e-9, -1e-9], 2e-9: [0, 0, -1e-9, -1e-9],
                        3e-9: [3e-9] * 4}[height]
            np.testing.assert_allclose(heights, expected, atol=1e-20)


class Loops(unittest.TestCase):
    def test_trace_and_retrace_are_told_apart(self):
        loop, position = FrictionLoop(), 0.0
        for velocity in [2e-6] * 5 + [-2e-6] * 5 + [2e-6] * 3:
            loop.add(SimpleNamespace(epoch=0, holder_position=position, drag_velocity=velocity, sample_period=5e-6,
                                     lateral=np.full(2000, -math.copysign(1e-12, velocity))), 25.5, TAU_S)
            position += velocity * 0.01
        self.assertEqual(loop.direction, 1)
        trace, retrace = loop.lines[1], loop.lines[-1]
        np.testing.assert_allclose(trace[1], 25.5e-12)
        np.testing.assert_allclose(retrace[1], -25.5e-12)
        self.assertTrue(0.0 <= trace[0].min() and trace[0].max() <= 6e-8)      # the new trace alone
        self.assertTrue(0.0 <= retrace[0].min() and retrace[0].max() <= 1e-7)
        self.assertTrue(np.all(np.diff(trace[0]) > 0.0) and np.all(np.diff(retrace[0]) < 0.0))

    def test_of_the_hammer_show_its_force_though_it_does_not_bend(self):
        loop = FrictionLoop()
        loop.add(SimpleNamespace(epoch=0, holder_position=0.0, drag_velocity=2e-6, sample_period=5e-6,
                                 lateral=np.zeros(2000), lateral_impulse=0.01 * 142e-12), 25.5, TAU_S)
        np.testing.assert_allclose(loop.lines[1][1], 142e-12)


class Trails(unittest.TestCase):
    def test_leaves_a_point_for_every_drag_speed(self):
        trail = Trail()
        for eta, k_f in ((2.0, 5.0), (2.0, 6.0), (-2.5, 1.0), (3.0, float('nan')), (4.0, 6.0)):
            trail.add(eta, k_f, 0.1)
        np.testing.assert_array_equal(trail.past, [[2.0, 2.5], [6.0, 1.0]])
        self.assertEqual(trail.now, (4.0, 6.0, 0.1))
        trail.end_run()
        np.testing.assert_array_equal(trail.past, [[2.0, 2.5, 4.0], [6.0, 1.0, 6.0]])
        self.assertIsNone(trail.now)


class Scales(unittest.TestCase):
    def test_hold_all_and_seldom_change(self):
        scale, chance, changes = Scale(1.0), np.random.default_rng(4), 0
        for _ in range(500):
            low, high = np.sort(chance.normal(scale=30.0, size=20))[[0, -1]]
            changes += scale.update(low, high)
            self.assertTrue(scale.low <= low and high <= scale.high)
        self.assertLess(changes, 20)
        self.assertEqual(sum(scale.update(0.0, 1.0) for _ in range(100)), 1)
        self.assertLessEqual(scale.high - scale.low, 2.0)


if __name__ == '__main__':
    unittest.main()

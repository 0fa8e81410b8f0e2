#!/usr/bin/python3
"""Every shipped scene shows what its file says one sees."""
import math
from pathlib import Path

import roslib.packages
import rospy
import yaml
from afm_emulator.msg import Impact
from std_msgs.msg import Float64

from emulator_under_test import FRICTION_UNIT, PACKAGE, SPEED_UNIT, TAU_S, NodeTest, run
from topics import NAMESPACE, TOPICS, Topic, wait_until

CONFIG = Path(roslib.packages.get_pkg_dir(PACKAGE)) / 'config'
PEAK = 6.061052  # m_tip/tau, at every even eta, in closed form


class Scenes(NodeTest):
    def play(self, scene, **arguments):
        self.topics = {name: Topic(name) for name in TOPICS}
        self.process = self.launch('emulator.launch', scene=scene, **arguments)
        self.topics['status'].wait_for()
        for topic in self.topics.values():
            topic.wait_for_connection()
        self.status, self.friction, self.impacts = (self.topics[name] for name in ('status', 'friction', 'impacts'))

    def tearDown(self):
        """Alive, and nothing happened that never should."""
        last = self.status.wait_for_next(what='alive')
        self.assertIsNone(self.process.child.poll())
        never = (last.budget_exhausted, last.search_failures, last.dropped_messages, last.refused_commands)
        self.assertEqual(never, (0, 0, 0, 0))
        self.assertLess(last.worst_penetration, 1e-13 * 0.52e-9)
        for topic in self.topics.values():
            topic.close()
        self.process.stop()

    def after(self, seconds):
        """The estimate of friction after so much model time with every topic connected: on a slow machine the emulator
        has come far by then."""
        begin = self.friction.wait_for_next().time.tau
        estimate = self.friction.wait_for(lambda m: (m.time.tau - begin) * TAU_S >= seconds, '%g s of model time' % seconds)
        # showers of impacts take Python longer than the emulator
        wait_until(lambda: self.impacts.messages and self.impacts.messages[-1].header.seq >= estimate.header.seq,
                   'impacts of the same time', deadline_s=60.0)
        return estimate

    def events(self, begin_s=0.0):
        return [i for m in self.impacts.messages for i in m.impacts if i.time.tau * TAU_S >= begin_s]

    def assert_friction(self, estimate, expected, most):
        error = max(estimate.window_k_f_std_error, 1e-4 * estimate.window_k_f) / FRICTION_UNIT
        self.assertLess(error, most)
        self.assertLess(abs(estimate.window_k_f / FRICTION_UNIT - expected), 4 * error)

    def assert_friction_by_work(self, estimate, expected, most):
        error = estimate.k_f_work_std_error / FRICTION_UNIT
        self.assertLess(error, most)
        self.assertLess(abs(estimate.k_f_work / FRICTION_UNIT - expected), 4 * error)

    def test_paper_is_chaos_with_the_friction_of_its_attractor(self):
        self.play('paper')
        self.assert_friction(self.after(2.0), 0.2533, 0.01)
        phases = sorted(i.surface_phase for i in self.events(0.5) if i.kind == Impact.IMPACT)
        self.assertGreater(len(phases), 10000)
        self.assertLess(max(b - a for a, b in zip(phases[100:-100], phases[101:-100])), 0.2)  # no few points for ever

    def test_resonance_repeats_itself_to_the_last_digits(self):
        self.play('resonance')
        self.assert_friction(self.after(1.0), PEAK, 0.02)
        found = self.events(0.5)
        self.assertEqual({i.kind for i in found}, {Impact.IMPACT})
        for name in 'surface_phase', 'normal_speed', 'energy_loss':
            values = [getattr(i, name) for i in found]
            self.assertLess(max(values) - min(values), 1e-9 * max(values), name)
        self.assertAlmostEqual(self.status.wait_for_next().impacts_per_tau, 2.0, delta=0.02)

    def test_splash_has_showers_of_bounces(self):
        self.play('splash')
        self.assert_friction(self.after(2.0), 0.0796, 0.002)
        found = self.events(1.0)
        kinds = {kind: sum(i.kind == kind for i in found) for kind in range(4)}
        self.assertGreater(kinds[Impact.BURST], 1000, kinds)
        self.assertGreater(sum(i.count for i in found), 25 * 1.0 / TAU_S)
        singles = sorted(i.normal_speed for i in found if i.kind == Impact.IMPACT)
        self.assertLess(singles[len(singles) // 4], 0.01 * singles[-1])
        self.assertLess(max(i.normal_speed for i in found if i.kind == Impact.BURST), 0.05 * singles[-1])

    def test_glide_has_no_phantom_impacts(self):
        self.play('glide')
        estimate = self.after(1.5)
        # the beginning of contact, before anyone may have listened, and nothing since
        self.assertLessEqual({i.kind for i in self.events()}, {Impact.CONTACT_BEGUN})
        last = self.impacts.messages[-1]
        self.assertEqual(last.first_index + len(last.impacts), 1)
        self.assertEqual((estimate.force, estimate.k_f), (0.0, 0.0))
        deflection = self.topics['deflection'].messages[-1]
        self.assertGreater(max(deflection.vertical), 0.999 * 5e-11)  # over the crests
        self.assertLess(min(deflection.vertical), -0.999 * 5e-11)    # into the valleys
        self.assertLess(max(abs(x) for x in deflection.lateral), 1e-4 * 5e-11)

    def test_rest_waits_and_wakes(self):
        self.play('rest')
        resting = self.after(1.0)
        self.assertTrue(math.isnan(resting.k_f) and resting.force == 0.0)
        self.assertEqual(self.events(0.5), [])
        deflection = self.topics['deflection'].messages[-1]
        self.assertEqual(len(set(deflection.vertical) | set(deflection.lateral)), 2)  # not a digit moves
        commands = rospy.Publisher(NAMESPACE + '/drag_velocity', Float64, queue_size=10)
        wait_until(lambda: commands.get_num_connections() > 0, 'it listens')
        commands.publish(4 * SPEED_UNIT)
        moving = self.friction.wait_for(lambda m: m.eta > 0 and m.window_k_f > 0.9 * PEAK * FRICTION_UNIT, 'the peak')
        self.assertGreater(moving.impact_count, 100)

    def test_sweep_goes_up_and_down_with_hysteresis(self):
        self.play('sweep', time_scale=4)
        eta = yaml.safe_load((CONFIG / 'commands' / 'sweep.yaml').read_text())['eta']
        drags = self.topics['applied_drag']

        def reported():
            return [round(m.drag_velocity / SPEED_UNIT, 9) for m in drags.messages]
        begin = wait_until(lambda: eta[0] in reported()[1:] and reported().index(eta[0], 1), 'from the first on')
        wait_until(lambda: len(drags.messages) > begin + len(eta), 'once up and down', deadline_s=30.0)
        self.assertEqual(reported()[begin:begin + len(eta)], eta)
        # a moment of their own, for estimates come by another way than drags
        self.friction.wait_for(lambda m: m.time.tau > drags.messages[begin + len(eta)].time.tau, 'of the next round')
        ends = {}  # the last estimate of each
        for m in self.friction.messages:
            index = sum(d.time.tau < m.time.tau for d in drags.messages) - 1
            ends[index] = m.k_f_natural
        friction = [ends[begin + i] for i in range(len(eta))]
        top = eta.index(max(eta))
        self.assertAlmostEqual(friction[eta.index(6.0)], PEAK, delta=0.02 * PEAK)
        up, down = friction[eta.index(5.65)], friction[eta.index(5.65, top)]
        self.assertAlmostEqual(up, 1.257, delta=0.03)
        self.assertAlmostEqual(down, 0.687, delta=0.03)

    def test_room_has_the_friction_of_a_damped_and_heated_tip(self):
        self.play('room')
        self.assert_friction_by_work(self.after(2.0), 4.17, 0.1)
        # heat: no two impacts alike, where the scene resonance repeats itself
        speeds = {round(i.normal_speed, 12) for i in self.events(0.5) if i.kind == Impact.IMPACT}
        self.assertGreater(len(speeds), 1000)

    def test_loop_opens_by_twice_the_friction(self):
        self.play('loop')
        drags = self.topics['applied_drag']
        wait_until(lambda: len(drags.messages) > 12, 'six traces and retraces', deadline_s=60.0)
        self.friction.wait_for(lambda m: m.time.tau > drags.messages[12].time.tau)
        ends = {}  # the last estimate of each
        for m in self.friction.messages:
            ends[sum(d.time.tau < m.time.tau for d in drags.messages) - 1] = m
        traces = [ends[i] for i in range(1, 12)]
        self.assertEqual({math.copysign(1, m.mean_lateral_force) for m in traces[::2]}, {math.copysign(1, traces[0].eta)})
        opening = [(a.mean_lateral_force - b.mean_lateral_force) * math.copysign(1, a.eta) for a, b in zip(traces, traces[1:])]
        half = 0.5 * sum(opening) / len(opening)
        self.assertAlmostEqual(half / (4.17 * FRICTION_UNIT * 2 * SPEED_UNIT), 1.0, delta=0.1)

    def test_slow_motion_shows_single_impacts(self):
        self.play('slow_motion')
        last = self.friction.wait_for(lambda m: m.time.tau >= 2, 'two tau')
        found = self.events()
        self.assertTrue(2 <= len(found) <= 20, len(found))
        deflection = self.topics['deflection'].messages
        self.assertLessEqual(max(len(m.vertical) for m in deflection), 2)
        wall = (last.header.stamp - deflection[0].header.stamp).to_sec()
        model = (last.time.tau + last.time.phase) * TAU_S
        self.assertAlmostEqual(model / wall, 1e-4, delta=2e-5)


if __name__ == '__main__':
    run(Scenes)

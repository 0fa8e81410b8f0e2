"""Every shipped scene has the parameters of its file and shows what that says one sees. All are started paused, and
stepped: faster than time passes, and with nothing lost."""
import math

import rospy
import yaml
from afm_emulator.msg import Impact
from afm_emulator.srv import Step
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from emulator_under_test import FRICTION_UNIT, SHARE, SPEED_UNIT, TAU_S, Emulators, NodeTest, call_service
from topics import TOPICS, Topic, key, wait_until

SCENES = SHARE / 'config' / 'scenes'
PEAK = 6.061052  # m_tip/tau, at every even eta, in closed form
MOST_TAU = 10000  # of a step


class Scenes(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.emulators = Emulators([dict(scene=path.stem, name=path.stem, paused='true')
                                   for path in sorted(SCENES.glob('*.yaml'))])

    @classmethod
    def tearDownClass(cls):
        cls.emulators.clean_up()

    def play(self, scene):
        self.scene, self.parameters = scene, yaml.safe_load((SCENES / (scene + '.yaml')).read_text())
        self.topics = {name: Topic('/%s/%s' % (scene, name)) for name in TOPICS}
        for topic in self.topics.values():
            topic.wait_for_connection()
        self.status, self.friction, self.impacts, self.applied = (
            self.topics[name] for name in ('status', 'friction', 'impacts', 'applied'))
        first = self.status.wait_for()
        self.assertEqual((key(first.time), first.paused), ((0, 0.0), True))
        configuration = self.topics['configuration'].wait_for()
        for name, value in self.parameters.items():
            if not name.startswith('commands_'):
                self.assertEqual(getattr(configuration, name), value, name)

    def tearDown(self):
        """Nothing happened that never should."""
        last = self.status.wait_for_next(what='alive')
        never = (last.budget_exhausted, last.search_failures, last.dropped_messages, last.refused_commands)
        self.assertEqual(never, (0, 0, 0, 0))
        self.assertLess(last.worst_penetration, 1e-13 * 0.52e-9)

    def call(self, service, kind, **request):
        answer = call_service('/%s/%s' % (self.scene, service), kind, **request)
        self.assertTrue(answer.success, answer.message)
        return answer

    def after(self, seconds):
        """The estimate of friction after so much more model time, and all that was published until then."""
        tau = seconds / TAU_S
        while tau > 0.0:
            end = self.call('step', Step, tau=min(tau, MOST_TAU), impacts=0).time
            tau -= MOST_TAU
        estimate = self.friction.wait_for(lambda m: key(m.time) == key(end), '%g s of model time' % seconds)
        for name in ('deflection', 'impacts'):
            self.topics[name].wait_for(lambda m: m.header.seq == estimate.header.seq, 'of the same time')
        return estimate

    def commands(self, count):
        """Of the scene, `count` at least: they may come after an estimate of friction that is later."""
        def come():
            found = [m for m in self.applied.messages if m.cause == 'scene']
            return found if len(found) >= count else None
        return wait_until(come, '%d commands of the scene' % count)

    def last_of_each_command(self, count):
        """The last estimate of friction that each command of the scene came to, in order."""
        begins = [key(m.time) for m in self.commands(count)]
        ends = {}
        for m in self.friction.messages:
            ends[sum(begin <= key(m.begin) for begin in begins) - 1] = m
        return [ends[i] for i in range(len(begins))]

    def events(self, begin_s=0.0):
        return [i for m in self.impacts.messages for i in m.impacts if i.time.tau * TAU_S >= begin_s]

    def assert_friction(self, estimate, expected, most, of='window_k_f'):
        k_f = getattr(estimate, of)
        error = max(getattr(estimate, of + '_std_error'), 1e-4 * k_f) / FRICTION_UNIT
        self.assertLess(error, most)
        self.assertLess(abs(k_f / FRICTION_UNIT - expected), 4 * error)

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
        self.assertAlmostEqual(len(found) * TAU_S / 0.5, 2.0, delta=0.02)

    def test_splash_has_rows_of_many_bounces(self):
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
        self.assertEqual([i.kind for i in self.events()], [Impact.CONTACT_BEGUN])
        self.assertEqual((estimate.force, estimate.k_f), (0.0, 0.0))
        latest = self.topics['deflection'].messages[-5:]
        self.assertGreater(max(max(m.vertical) for m in latest), 0.999 * 5e-11)  # over the crests
        self.assertLess(min(min(m.vertical) for m in latest), -0.999 * 5e-11)    # into the valleys
        self.assertLess(max(abs(x) for m in latest for x in m.lateral), 1e-4 * 5e-11)

    def test_rest_waits_and_wakes(self):
        self.play('rest')
        resting = self.after(1.0)
        self.assertEqual((resting.force, resting.eta), (0.0, 0.0))
        for name in ('k_f', 'k_f_natural', 'k_f_work', 'k_f_work_natural', 'window_k_f', 'window_k_f_natural'):
            self.assertTrue(math.isnan(getattr(resting, name)), name)
        self.assertEqual(self.events(0.5), [])
        deflection = self.topics['deflection'].messages[-1]
        self.assertEqual(len(set(deflection.vertical) | set(deflection.lateral)), 2)  # not a digit moves
        others = [Topic('/%s/applied' % path.stem) for path in SCENES.glob('*.yaml') if path.stem != 'rest']
        for other in others:
            other.wait_for()
        commands = rospy.Publisher('/rest/drag_velocity', Float64, queue_size=10)
        wait_until(lambda: commands.get_num_connections() > 0, 'it listens')
        commands.publish(4 * SPEED_UNIT)
        self.applied.wait_for(lambda m: m.drag_velocity == 4 * SPEED_UNIT, 'the command')
        self.assertGreater(self.after(1.0).window_k_f_natural, 0.9 * PEAK)
        causes = {m.cause for other in others for m in other.messages}
        self.assertLessEqual(causes, {'epoch', 'scene'}, 'a command to one emulator moved another')

    def test_sweep_goes_up_and_down_with_hysteresis(self):
        self.play('sweep')
        eta = self.parameters['commands_eta']
        self.after(len(eta) * self.parameters['commands_hold_s'])
        reported = [round(m.drag_velocity / SPEED_UNIT, 9) for m in self.commands(len(eta))]
        self.assertEqual(reported[:len(eta)], eta)
        friction = [m.k_f_natural for m in self.last_of_each_command(len(eta))]
        top = eta.index(max(eta))
        self.assertAlmostEqual(friction[eta.index(6.0)], PEAK, delta=0.02 * PEAK)
        self.assertAlmostEqual(friction[eta.index(5.65)], 1.257, delta=0.03)
        self.assertAlmostEqual(friction[eta.index(5.65, top)], 0.687, delta=0.03)

    def test_room_has_the_friction_of_a_damped_and_heated_tip(self):
        self.play('room')
        self.assert_friction(self.after(2.0), 4.17, 0.1, of='k_f_work')
        # heat: no two impacts alike, where the scene resonance repeats itself
        speeds = {round(i.normal_speed, 12) for i in self.events(0.5) if i.kind == Impact.IMPACT}
        self.assertGreater(len(speeds), 1000)

    def test_loop_opens_by_twice_the_friction(self):
        self.play('loop')
        self.after(12 * self.parameters['commands_hold_s'])
        traces = self.last_of_each_command(12)[:12]
        self.assertEqual({math.copysign(1, m.mean_lateral_force) for m in traces[::2]},
                         {math.copysign(1, traces[0].eta)})
        opening = [(a.mean_lateral_force - b.mean_lateral_force) * math.copysign(1, a.eta)
                   for a, b in zip(traces, traces[1:])]
        half = 0.5 * sum(opening) / len(opening)
        self.assertAlmostEqual(half / (4.17 * FRICTION_UNIT * 2 * SPEED_UNIT), 1.0, delta=0.1)

    def test_slow_motion_shows_single_impacts(self):
        self.play('slow_motion')
        self.call('pause', SetBool, data=False)
        last = self.friction.wait_for(lambda m: m.time.tau >= 1, 'one tau')
        found = self.events()
        self.assertTrue(1 <= len(found) <= 10, len(found))
        deflection = self.topics['deflection'].messages
        self.assertLessEqual(max(len(m.vertical) for m in deflection), 2)
        wall = (last.header.stamp - deflection[0].header.stamp).to_sec()
        model = ((last.time.tau + last.time.phase) - (deflection[0].time.tau + deflection[0].time.phase)) * TAU_S
        self.assertAlmostEqual(model / wall, 1e-4, delta=2e-5)

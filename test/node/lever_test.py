"""Every lever that is shipped runs on a crystal under a load, in the terms of its owner."""
import math
from pathlib import Path

import dynamic_reconfigure.client
import yaml
from afm_emulator.srv import Control

from emulator_under_test import SHARE, Emulator, Emulators, NodeTest, Process, call_service
from topics import Topic, wait_until

CONFIG = SHARE / 'config'
LOAD = 0.4e-9  # [N]
BOLTZMANN = 1.380649e-23
LEVERS = sorted((CONFIG / 'levers').glob('*.yaml'))


def settings(kind, name):
    return yaml.safe_load((CONFIG / kind / (name + '.yaml')).read_text())


class LeverTest(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.emulators = Emulators([dict(name=path.stem, lever=path.stem, surface='nacl', load_n=LOAD, temperature_k=300,
                                        quality_factor=20, pace='lockstep') for path in LEVERS])

    @classmethod
    def tearDownClass(cls):
        cls.emulators.clean_up()

    def advance(self, name, seconds):
        answer = call_service('/%s/control' % name, Control, drag_velocity=math.nan, rest_height=math.nan,
                              duration=seconds)
        self.assertTrue(answer.success, answer.message)
        return answer

    def test_every_shipped_lever(self):
        surface = settings('surfaces', 'nacl')
        for path in LEVERS:
            name, lever = path.stem, settings('levers', path.stem)
            with self.subTest(lever=name):
                c = Topic('/%s/configuration' % name).wait_for()
                k = lever['spring_constant_n_per_m']
                self.assertAlmostEqual(c.omega_v_rad_per_s / (2 * math.pi) / lever['resonance_hz'], 1.0, delta=1e-12)
                self.assertAlmostEqual(c.tip_mass_kg * c.omega_v_rad_per_s ** 2 / k, 1.0, delta=1e-12)
                lateral = c.tip_mass_kg * c.omega_h_rad_per_s ** 2
                self.assertAlmostEqual(lateral / lever['lateral_spring_constant_n_per_m'], 1.0, delta=1e-12)
                self.assertEqual((c.lattice_spacing_m, c.surface_amplitude_m),
                                 (surface['lattice_spacing_m'], surface['surface_amplitude_m']))
                self.assertAlmostEqual(-k * c.rest_height_m / LOAD, 1.0, delta=1e-12)

    def test_the_tip_carries_its_load(self):
        """The mean normal force is the load, but for the height at which the tip is: the corrugation, and above it the
        heat."""
        for name in ('ppp_cont', 'laterally_soft'):
            with self.subTest(lever=name):
                friction = Topic('/%s/friction' % name)
                friction.wait_for_connection()
                answer = self.advance(name, 0.02)
                last = friction.wait_for(lambda m: m.time == answer.end, 'the end of the period')
                k, surface = settings('levers', name)['spring_constant_n_per_m'], settings('surfaces', 'nacl')
                higher = surface['surface_amplitude_m'] + math.sqrt(2.0 * BOLTZMANN * 300.0 / k)
                self.assertTrue(LOAD - k * surface['surface_amplitude_m'] < last.mean_normal_force < LOAD + k * higher,
                                last.mean_normal_force)
                self.assertAlmostEqual(last.mean_normal_force / answer.mean_normal_force, 1.0, delta=1e-9)

    def test_a_load_changes_live(self):
        """The range of its slider is that of the lever, in which the shipped range of the paper's tip would be lost."""
        lever, cell = settings('levers', 'csc37_b'), settings('surfaces', 'nacl')['lattice_spacing_m']
        load_at = -lever['spring_constant_n_per_m']  # times the rest height
        client = dynamic_reconfigure.client.Client('/csc37_b', timeout=60)
        least, most = ({d['name']: d[which] for d in client.get_parameter_descriptions(timeout=60)}
                       for which in ('min', 'max'))
        self.assertAlmostEqual(least['rest_height_m'] * load_at / LOAD, 2.0, delta=1e-12)
        self.assertAlmostEqual(most['cutoff_speed'] / (0.6 * cell * lever['resonance_hz']), 1.0, delta=1e-12)
        changed = client.update_configuration({'rest_height_m': 1.5 * LOAD / load_at})
        self.assertAlmostEqual(changed['rest_height_m'] * load_at / LOAD, 1.5, delta=1e-12)
        client.close()

    def test_a_load_comes_back_after_a_restart(self):
        """The parameter server also holds the height that dynamic_reconfigure shows; once the node refused both."""
        first = self.start(Emulator({'load_n': 1e-10, 'quality_factor': 100.0, 'temperature_k': 300.0}))
        height = 2.0 * Topic('configuration').wait_for().rest_height_m
        first.set(kicks_per_tau=3.125, rest_height_m=height)  # at omega_h/omega_v = 6.25
        first.child.kill()
        first.wait()
        self.assertIn('kicks_per_tau = 3.125: locks', first.output())
        Topic.close_all()
        self.start(Process(first.child.args))
        again = Topic('configuration').wait_for()
        self.assertEqual((again.rest_height_m, again.kicks_per_tau), (height, 3.125))

    def test_a_lever_of_ones_own(self):
        lever = Path(self.temporary_directory()) / 'mine.yaml'
        lever.write_text('{spring_constant_n_per_m: 0.1, resonance_hz: 9000, lateral_spring_constant_n_per_m: 50.0}')
        launch = self.launch('emulator.launch', name='mine', lever=lever, load_n='1e-9', pace='lockstep')
        c = Topic('/mine/configuration').wait_for()
        self.assertAlmostEqual(c.rest_height_m, -1e-8, delta=1e-20)
        for line in '0.1 N/m at 9000 Hz, 50 N/m laterally', 'times real time on this machine':
            wait_until(lambda: line in launch.output(), line)  # while it runs: it was written when it ended

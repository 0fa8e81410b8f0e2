"""What the launch files pass on, and that config/emulator.yaml says what the code does by itself. Each file is run by
another test of the node."""
import os
import re
import subprocess
from pathlib import Path

import roslaunch.config
import roslaunch.xmlloader
import rospy
import yaml
from afm_emulator.srv import Step

from emulator_under_test import SHARE, Emulator, NodeTest, call_service
from topics import Topic

SHIPPED = SHARE / 'config' / 'emulator.yaml'


def values(message):
    return {name: getattr(message, name) for name in message.__slots__ if name != 'header'}


class ShippedFiles(NodeTest):
    def configuration_of(self, parameters):
        configuration = Topic('configuration')
        emulator = self.start(Emulator(parameters))
        message = configuration.wait_for()
        emulator.assert_alive()
        configuration.close()
        self.assertEqual(emulator.stop(), 0)
        return values(message)

    def known_names(self):
        emulator = self.start(Emulator({'no_such_name': 1}))
        self.assertEqual(emulator.wait(), 1)
        names = re.search(r'there are ([\w, ]+)', emulator.output())
        return set(names.group(1).split(', '))

    def test_shipped_values_are_the_defaults(self):
        shipped = yaml.safe_load(SHIPPED.read_text())
        self.assertEqual(self.configuration_of(shipped), self.configuration_of({}))
        self.assertEqual(set(shipped), self.known_names())

    def test_launch_arguments_reach_the_node_and_parameters_of_an_earlier_run_do_not(self):
        rospy.set_param('/lab/tip', {'restitution_gamma': 0.4, 'no_longer_known': 1})
        directory, asked = self.temporary_directory(), {
            'time_scale': 0.5, 'drag_velocity': 6.6e-6, 'sample_rate_hz': 50000.0, 'batch_rate_hz': 50.0,
            'temperature_k': 77.0, 'seed': 3000000000}
        status, configuration = Topic('/lab/tip/status'), Topic('/lab/tip/configuration')
        play = self.launch('emulator.launch', dict(os.environ, ROS_NAMESPACE='lab'), scene='rest', record='true',
                           bag_directory=directory, name='tip', paused='true', **asked)
        first = status.wait_for(lambda m: m.recording, 'recording')
        self.assertEqual((first.paused, first.time.tau), (True, 0))
        got = values(configuration.wait_for())
        self.assertEqual({name: got[name] for name in asked}, asked)
        self.assertEqual((got['initial_u'], got['restitution_gamma']), (0.0, 0.7))  # of the scene, and as shipped
        self.assertFalse(rospy.has_param('/lab/tip/no_longer_known'))
        self.assertTrue(call_service('/lab/tip/step', Step, tau=100.0).success)
        play.stop()
        bag, = Path(directory).iterdir()
        self.assertEqual(bag.suffix, '.bag')

    @staticmethod
    def loaded(file, *arguments):
        """What roslaunch would start, and the parameters it would set."""
        config = roslaunch.config.ROSLaunchConfig()
        roslaunch.xmlloader.XmlLoader().load(str(file), config, argv=list(arguments), verbose=False)
        return config

    def test_a_scene_outside_the_package(self):
        scene = Path(self.temporary_directory()) / 'mine.yaml'
        scene.write_text('drag_velocity: 4.0e-6\n')
        os.environ['PWD'] = os.getcwd()  # as a shell has it
        for path in (str(scene), os.path.relpath(str(scene))):
            with self.subTest(path=path):
                config = self.loaded(SHARE / 'launch/emulator.launch', 'scene_file:=' + path)
                self.assertEqual(config.params['/afm/drag_velocity'].value, 4.0e-6)

    def test_a_scene_names_its_own_table_of_levels(self):
        """A <param> of the launch file stood before that of the scene."""
        scene = Path(self.temporary_directory()) / 'mine.yaml'
        for text, table in (('level_table: /tmp/mine.csv\n', '/tmp/mine.csv'),
                            ('drag_velocity: 4.0e-6\n', str(SHARE / 'config/levels.csv'))):
            scene.write_text(text)
            config = self.loaded(SHARE / 'launch/emulator.launch', 'scene_file:=' + str(scene))
            self.assertEqual(config.params['/afm/level_table'].value, table)

    def test_arguments_of_the_fixture_reach_the_emulator(self):
        scene = Path(self.temporary_directory()) / 'mine.yaml'
        scene.write_text('drag_velocity: 4.0e-6\n')
        asked = {'pace': 'lockstep', 'wait_for': 'command', 'command_wait_s': 30.0, 'load_n': 1e-9,
                 'quality_factor': 100.0, 'temperature_k': 300.0, 'seed': 5, 'record': False}
        params = self.loaded(SHARE / 'launch/test_fixture.launch', 'scene_file:=%s' % scene, 'lever:=ppp_cont',
                             'surface:=nacl', *('%s:=%s' % item for item in asked.items())).params
        self.assertEqual({name: params['/afm/' + name].value for name in asked}, asked)
        for file in ('levers/ppp_cont', 'surfaces/nacl'):
            for name, value in yaml.safe_load((SHARE / 'config' / (file + '.yaml')).read_text()).items():
                if name not in asked:
                    self.assertEqual(params['/afm/' + name].value, value)
        self.assertEqual(params['/afm/drag_velocity'].value, 4.0e-6)

    def test_a_misspelt_argument_of_scripts_run(self):
        """roslaunch passes over it."""
        done = subprocess.run([str(Path(__file__).resolve().parents[2] / 'scripts/run'), '--', 'scen:=paper'],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual((done.returncode, done.stdout),
                         (2, 'run: scen: launch/emulator.launch has no such argument\n'))

    def test_a_directory_may_be_named_by_a_number(self):
        """roslaunch takes it for one where it evaluates."""
        os.environ['PWD'] = os.getcwd()
        for file in ('emulator', 'test_fixture'):
            params = self.loaded(SHARE / 'launch' / (file + '.launch'), 'bag_directory:=007', 'record:=true').params
            self.assertEqual(params['/afm/bag_directory'].value, os.getcwd() + '/007', file)
        nodes = self.loaded(SHARE / 'launch/replay.launch', 'bag:=007').nodes
        self.assertIn("'%s/007'" % os.getcwd(), nodes[0].args)

    def test_a_load_of_nothing_is_a_load(self):
        """As a parameter, 0 leaves the height to the scene: once a loop over loads had the scene's height first."""
        scene = Path(self.temporary_directory()) / 'high.yaml'
        scene.write_text('rest_height_m: -1.0e-10\n')
        for load, height in (('0', 0.0), ('0.0', 0.0), ('', -1e-10)):
            params = self.loaded(SHARE / 'launch/emulator.launch', 'scene_file:=%s' % scene, 'load_n:=' + load).params
            self.assertEqual(params['/afm/rest_height_m'].value, height, load)

    def test_respawn(self):
        """roslaunch starts such a node again; one that is required, too, would end them all."""
        node, = self.loaded(SHARE / 'launch/emulator.launch', 'respawn:=true').nodes
        self.assertEqual((node.respawn, node.required), (True, False))

    def test_each_emulator_has_windows_of_its_own(self):
        """Of one name, those of the second emulator ended those of the first."""
        for name, prefix in (('afm', 'afm'), ('left', 'left')):
            nodes = self.loaded(SHARE / 'launch/emulator.launch', 'name:=' + name, 'view:=true', 'panel:=true').nodes
            self.assertEqual({node.name for node in nodes},
                             {name, prefix + '_view', prefix + '_view_rviz', prefix + '_panel'})

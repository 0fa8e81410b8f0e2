#!/usr/bin/python3
"""Every launch file that we ship works, and config/emulator.yaml says what the code does by itself."""
import os
import re
import signal
from pathlib import Path

import roslaunch.config
import roslaunch.xmlloader
import roslib.packages
import yaml
from afm_emulator.srv import Step

from emulator_under_test import PACKAGE, Emulator, NodeTest, call_service, pid_of_node, run
from topics import Topic, wait_until

SHARE = Path(roslib.packages.get_pkg_dir(PACKAGE))
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

    def test_launch_arguments_reach_the_node(self):
        directory, asked = self.temporary_directory(), {
            'time_scale': 0.5, 'drag_velocity': 6.6e-6, 'sample_rate_hz': 50000.0, 'batch_rate_hz': 50.0,
            'temperature_k': 77.0, 'seed': 5}
        status, configuration = Topic('/tip/status'), Topic('/tip/configuration')
        play = self.launch('emulator.launch', scene='rest', record='true', bag_directory=directory, name='tip',
                           paused='true', **asked)
        first = status.wait_for(lambda m: m.recording, 'recording')
        self.assertEqual((first.paused, first.time.tau), (True, 0))
        got = values(configuration.wait_for())
        self.assertEqual({name: got[name] for name in asked}, asked)
        self.assertEqual(got['initial_u'], 0.0)  # of the scene
        self.assertTrue(call_service('/tip/step', Step, tau=100.0).success)
        play.stop()
        bag, = Path(directory).iterdir()
        self.assertEqual(bag.suffix, '.bag')

    def test_respawn(self):
        self.launch('emulator.launch', name='tip', respawn='true')
        status = Topic('/tip/status')
        status.wait_for()
        first = pid_of_node('/tip')
        os.kill(first, signal.SIGKILL)
        wait_until(lambda: pid_of_node('/tip') not in (None, first), 'another process of that name')

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

    def test_launch_files_load(self):
        files = sorted((SHARE / 'launch').glob('*.launch'))
        self.assertTrue(files)
        for file in files:
            with self.subTest(file=file.name):
                self.assertTrue(self.loaded(file, *(['bag:=some.bag'] if file.name == 'replay.launch' else [])).nodes)


if __name__ == '__main__':
    run(ShippedFiles)

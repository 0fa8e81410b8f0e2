#!/usr/bin/python3
"""Every scene and launch file that we ship works, and config/emulator.yaml says what the code does by itself."""
import os
import re
import subprocess
from pathlib import Path

import roslib.packages
import yaml

import bags
from emulator_under_test import PACKAGE, Emulator, NodeTest, run
from topics import Topic

SHARE = Path(roslib.packages.get_pkg_dir(PACKAGE))
SCENES = sorted(path.stem for path in (SHARE / 'config' / 'scenes').glob('*.yaml'))
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

    def assert_plays(self, scene):
        deflection, configuration = Topic('deflection'), Topic('configuration')
        play = self.launch('emulator.launch', scene=scene)
        first = deflection.wait_for()
        deflection.wait_for(lambda m: m.first_sample > first.first_sample, 'goes on')
        asked = yaml.safe_load((SHARE / 'config' / 'scenes' / (scene + '.yaml')).read_text())
        got = values(configuration.wait_for())
        self.assertEqual({name: got[name] for name in asked}, asked)
        Topic.close_all()
        play.stop()

    def test_every_scene_plays(self):
        self.assertTrue(SCENES)
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.assert_plays(scene)

    def test_launch_arguments_reach_the_node(self):
        directory = self.temporary_directory()
        status, configuration = Topic('status'), Topic('configuration')
        play = self.launch('emulator.launch', scene='rest', record='true', bag_directory=directory, time_scale=0.5,
                           drag_velocity=6.6e-6)
        status.wait_for(lambda m: m.recording and m.time.tau > 1000, 'recording')
        got = configuration.wait_for()
        self.assertEqual((got.time_scale, got.drag_velocity, got.initial_u), (0.5, 6.6e-6, 0.0))
        play.stop()
        bag, = Path(directory).iterdir()
        bags.assert_sound(self, str(bag))

    def test_a_scene_outside_the_package(self):
        scene = Path(self.temporary_directory()) / 'mine.yaml'
        scene.write_text('drag_velocity: 4.0e-6\n')
        for path in (str(scene), os.path.relpath(str(scene))):
            with self.subTest(path=path):
                dumped = subprocess.run(['roslaunch', '--dump-params', str(SHARE / 'launch/emulator.launch'), 'scene_file:=' + path],
                                        env=dict(os.environ, PWD=os.getcwd()), stdout=subprocess.PIPE, universal_newlines=True)
                self.assertEqual(yaml.safe_load(dumped.stdout)['/afm/drag_velocity'], 4.0e-6)

    def test_launch_files_load(self):
        files = sorted((SHARE / 'launch').glob('*.launch'))
        self.assertTrue(files)
        for file in files:
            arguments = ['bag:=some.bag'] if file.name == 'replay.launch' else []
            with self.subTest(file=file.name):
                listed = subprocess.run(['roslaunch', '--nodes', str(file)] + arguments, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, universal_newlines=True)
                self.assertEqual(listed.returncode, 0, listed.stdout)
                self.assertIn('/', listed.stdout)


if __name__ == '__main__':
    run(ShippedFiles)

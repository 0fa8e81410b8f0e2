#!/usr/bin/python3
"""package.xml declares every package that the sources include and the scripts import.

Usage: package_test.py ROOT
"""
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
PYTHON_PACKAGES = {'matplotlib': 'python3-matplotlib', 'numpy': 'python3-numpy'}
# what catkin, roscpp and rospy bring, by the names that are included or imported
BROUGHT_BY = {'ros': 'roscpp', 'genpy': 'rospy', 'roslib': 'rospy', 'rosunit': 'rostest', 'XmlRpcValue': 'roscpp'}


def is_ros(name):
    return re.fullmatch(r'(ros|rospy|rosbag|rosgraph|roslaunch|roslib|rostest|rosunit|genpy|diagnostic_updater|'
                        r'dynamic_reconfigure|\w+_(msgs|srvs))', name) is not None


def uses(folder, suffixes, pattern):
    for path in sorted((ROOT / folder).rglob('*')):
        if path.is_file() and (path.suffix in suffixes):
            for name in re.findall(pattern, path.read_text(), re.M):
                yield path.relative_to(ROOT), name


class Package(unittest.TestCase):
    def setUp(self):
        self.package = xml.etree.ElementTree.parse(str(ROOT / 'package.xml')).getroot()

    def declared(self, *kinds):
        return {element.text for kind in kinds for element in self.package.findall(kind)}

    def assert_declared(self, found, declared):
        found = list(found)
        self.assertTrue(found)
        for path, name in found:
            name = BROUGHT_BY.get(name, PYTHON_PACKAGES.get(name, name))
            self.assertIn(name, declared, '%s uses %s, which package.xml does not declare' % (path, name))

    def test_what_the_sources_include(self):
        found = [use for folder in ('src', 'include', 'examples/ros')
                 for pattern in (r'^#include <(\w+)/', r'\b(\w+_msgs)::')
                 for use in uses(folder, ('.h', '.cpp'), pattern) if is_ros(use[1])]
        self.assert_declared(found, self.declared('depend', 'build_depend'))

    def test_what_the_scripts_import(self):
        known = self.declared('depend', 'exec_depend')
        found = [use for folder in ('scripts', 'examples/ros')
                 for use in uses(folder, ('', '.py'), r'^\s*(?:import|from) (\w+)')
                 if is_ros(use[1]) or use[1] in PYTHON_PACKAGES]
        self.assert_declared(found, known)

    def test_what_the_tests_import(self):
        known = self.declared('depend', 'exec_depend', 'test_depend')
        found = [use for use in uses('test', ('.py',), r'^\s*(?:import|from) (\w+)') if is_ros(use[1])]
        self.assert_declared(found, known)

    def test_no_package_is_installed_twice(self):
        # the second of its name would be missing for ever: apt would be asked each time
        for options in ([], ['--without-ros'], ['--emulator', '--plot', '--panel'], ['--panel', '--plot', '--view']):
            names = subprocess.run([str(ROOT / 'scripts/install_dependencies'), *options, '--list'], check=True,
                                   stdout=subprocess.PIPE, universal_newlines=True).stdout.split()
            self.assertGreater(len(names), 10)
            self.assertEqual(sorted(set(names)), sorted(names), options)

    def test_somebody_can_be_reached(self):
        for maintainer in self.package.findall('maintainer'):
            self.assertNotRegex(maintainer.get('email'), r'\.invalid$|^TODO')


if __name__ == '__main__':
    unittest.main()

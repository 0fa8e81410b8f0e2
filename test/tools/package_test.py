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
# what other packages bring, by the names that are included or imported
BROUGHT_BY = {'ros': 'roscpp', 'genpy': 'rospy', 'roslib': 'rospy', 'rosunit': 'rostest',
              'matplotlib': 'python3-matplotlib', 'numpy': 'python3-numpy'}
IMPORT = r'^\s*(?:import|from) (\w+)'
# where packages are used, by what pattern they are found, and how they are declared, if not by <depend>
USES = ((('src', 'include', 'examples/ros'), ('.h', '.cpp'), r'(?:^#include <(?=\w+/)|\b(?=\w+_msgs::))(\w+)',
         ('build_depend',)),
        (('scripts', 'examples/ros', 'python/client'), ('', '.py'), IMPORT, ('exec_depend',)),
        (('test',), ('.py',), IMPORT, ('exec_depend', 'test_depend')))


def is_ros(name):
    return re.fullmatch(r'(ros|rospy|rosbag|rosgraph|roslaunch|roslib|rostest|rosunit|genpy|diagnostic_updater|'
                        r'dynamic_reconfigure|\w+_(msgs|srvs))', name) is not None


class Package(unittest.TestCase):
    package = xml.etree.ElementTree.parse(str(ROOT / 'package.xml')).getroot()

    def test_what_is_used_is_declared(self):
        for folders, suffixes, pattern, kinds in USES:
            declared = {element.text for kind in ('depend', *kinds) for element in self.package.findall(kind)}
            files = [path for folder in folders for path in (ROOT / folder).rglob('*')
                     if path.is_file() and path.suffix in suffixes]
            found = [(path, name) for path in files for name in re.findall(pattern, path.read_text(), re.M)
                     if is_ros(name) or name in BROUGHT_BY]
            self.assertTrue(found)
            for path, name in found:
                self.assertIn(BROUGHT_BY.get(name, name), declared, '%s uses %s: not in package.xml' % (path, name))

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

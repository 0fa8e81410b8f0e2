"""With parameters that cannot be, the node reports them in one error, ends with exit code 1 and has advertised nothing.
parameters_test.cpp tests which those are."""
import os
import re
from pathlib import Path
from unittest import mock

from emulator_under_test import NodeTest, Process, find
from own_master import own_master
from topics import NAMESPACE


class BadParameters(NodeTest):
    def test_a_name_that_cannot_be(self):
        for kind, argument in (('emulator_node', '__name:=a-b'), ('view_node', '_emulator:=a-b')):
            node = self.start(Process([find(kind), argument]))
            self.assertEqual(node.wait(), 1)
            self.assertIn('a-b', node.output())

    def test_all_faults_in_one_error(self):
        log = Path(self.temporary_directory())
        with mock.patch.dict(os.environ, ROS_LOG_DIR=str(log)), own_master() as master:
            master.setParam('test', NAMESPACE, {'restitution_gamma': 1.5, 'batch_rate_hz': 'fast', 'gama': 0.7})
            emulator = self.start(Process([find('emulator_node'), '__name:=' + NAMESPACE[1:]]))
            self.assertEqual(emulator.wait(), 1)
        error, = [line for line in emulator.output().splitlines() if 'ERROR' in line or 'FATAL' in line]
        for text in ('restitution_gamma = 1.5: ', 'batch_rate_hz = "fast": ', 'gama = 0.7: '):
            self.assertIn(text, emulator.output())
        advertised = re.findall(r'\+(?:PUB|SUB|SERVICE) \[%s/(\S+)\]' % NAMESPACE, (log / 'master.log').read_text())
        # the two that roscpp gives every node to set its log levels
        self.assertEqual(set(advertised), {'get_loggers', 'set_logger_level'})

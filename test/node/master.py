"""A ROS master of a test's own, to take away."""
import sys
import xmlrpc.client
from pathlib import Path

from emulator_under_test import Process
from topics import wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'scripts'))
from own_master import free_port  # noqa: E402


class Master(Process):
    def __init__(self, port=None):
        self.port = port or free_port()
        super().__init__(['rosmaster', '--core', '-p', str(self.port)])
        self.uri = 'http://localhost:%d' % self.port
        self.proxy = xmlrpc.client.ServerProxy(self.uri)
        wait_until(self.answers, 'the master answers')

    def answers(self):
        try:
            return self.proxy.getPid('test')[0] == 1
        except OSError:
            return False

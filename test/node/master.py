"""A ROS master of a test's own, to take away."""
import xmlrpc.client

from emulator_under_test import Process
from ports import free_port
from topics import wait_until


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

"""Shared by the tests of the node: the emulator as a process of its own, which is cleaned up after every test."""
import contextlib
import os
import re
import signal
import subprocess
import tempfile
import unittest
import xmlrpc.client

import roslib.packages
import rospy
import rostest
from std_msgs.msg import Float64

from topics import NAMESPACE, PATIENCE, Topic, wait_until

PACKAGE = 'afm_emulator'

# the paper's values, from which the expectations of the tests are made
TAU_S = 2 * 3.141592653589793 / 40e3
SPEED_UNIT = 0.52e-9 / TAU_S     # m/s for eta = 1
ENERGY_UNIT = 408e-12 * SPEED_UNIT ** 2
FRICTION_UNIT = 408e-12 / TAU_S  # kg/s for a K_f of 1 m_tip/tau


class Process:
    """A child whose output is kept, line by line as it is written."""

    def __init__(self, command, env=None, **options):
        self.log = tempfile.TemporaryFile('a+')  # appended to, wherever output() has read to
        self.child = subprocess.Popen(command, stdout=self.log, stderr=subprocess.STDOUT,
                                      env=dict(env or os.environ, PYTHONUNBUFFERED='1'), **options)

    def output(self):
        self.log.seek(0)
        return self.log.read()

    def wait(self, deadline_s=15.0):
        return self.child.wait(timeout=deadline_s * PATIENCE)

    def stop(self, with_signal=signal.SIGINT):
        self.child.send_signal(with_signal)
        return self.wait()

    def clean_up(self):
        """Asked first, so that the master forgets it: the address of a dead node can hide that of its heir from a subscriber."""
        try:
            if self.child.poll() is None:
                self.stop()
        except (subprocess.TimeoutExpired, AssertionError):
            self.child.kill()
            self.child.wait()
        print(self.output())


class Launch(Process):
    """roslaunch of a file of the package. Interrupted while it still starts a node it takes 10 to 20 s to end, so stop() waits
    until all have started."""

    def __init__(self, file, arguments, env=None):
        super().__init__(['roslaunch', PACKAGE, file] + ['%s:=%s' % item for item in arguments.items()], env)

    def has_started(self):
        text = self.output()
        names = re.findall(r'^ {4}(\S+) \(', text.partition('\nNODES\n')[2], re.M)
        started = re.findall(r'process\[(?:\S*/)?(\S+)-\d+\]: started', text)
        return bool(names) and set(names) <= set(started)

    def stop(self, with_signal=signal.SIGINT):
        wait_until(lambda: self.child.poll() is not None or self.has_started(), 'roslaunch has started all nodes', deadline_s=60.0)
        return super().stop(with_signal)


class Emulator(Process):
    def __init__(self, parameters=None, **environment):
        set_parameters(parameters or {})
        binary = roslib.packages.find_node(PACKAGE, 'emulator_node')[0]
        super().__init__([binary, '__name:=' + NAMESPACE[1:]], env=dict(os.environ, **environment))
        self.drag_publisher = rospy.Publisher(NAMESPACE + '/drag_velocity', Float64, queue_size=1000, tcp_nodelay=True)

    def call(self, service, kind, **request):
        name = NAMESPACE + '/' + service
        rospy.wait_for_service(name, timeout=10.0)
        return rospy.ServiceProxy(name, kind)(**request)

    def drag(self, velocity):
        wait_until(lambda: self.drag_publisher.get_num_connections() > 0, 'the emulator listens to drag_velocity')
        self.drag_publisher.publish(velocity)

    def assert_alive(self):
        status = Topic('status')
        status.wait_for(what='a sign of life')
        status.close()
        assert self.child.poll() is None, 'the emulator has ended with code %s' % self.child.poll()


def set_parameters(parameters):
    """These and no others: the master remembers what was set for an earlier node of the same name."""
    if rospy.has_param(NAMESPACE):
        rospy.delete_param(NAMESPACE)
    if parameters:
        rospy.set_param(NAMESPACE, parameters)


def pid_of_node():
    """Of the node of that name that the master knows."""
    _, _, uri = rospy.get_master().lookupNode(NAMESPACE)
    return xmlrpc.client.ServerProxy(uri).getPid('test')[2]


class NodeTest(unittest.TestCase):
    """Leaves nothing behind."""

    def setUp(self):
        self.addCleanup(Topic.close_all)

    @contextlib.contextmanager
    def subTest(self, **of):
        """The first that fails ends the test: rosunit does not print the failure of a subtest."""
        try:
            yield
        except AssertionError as error:
            raise AssertionError('%s: %s' % (of, error)) from error

    def start(self, process):
        self.addCleanup(process.clean_up)
        return process

    def launch(self, file, **arguments):
        return self.start(Launch(file, arguments))

    def temporary_directory(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        return directory.name


class EmulatorTest(NodeTest):
    """Every test has an emulator of its own, which must be alive at the end and then end well."""
    parameters = {}

    def setUp(self):
        super().setUp()
        self.emulator = self.start(Emulator(self.parameters))

    def tearDown(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)


def run(case):
    rospy.init_node('test', anonymous=True)
    rostest.rosrun(PACKAGE, case.__name__, case)

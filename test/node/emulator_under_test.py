"""Shared by the tests of the node: the emulator as a process of its own, which is cleaned up after every test."""
import contextlib
import math
import os
import re
import signal
import subprocess
import tempfile
import unittest
import xmlrpc.client
from pathlib import Path

import roslib.packages
import rospy
from afm_emulator.srv import Control, Step
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from topics import DEADLINE_S, NAMESPACE, PATIENCE, TOPICS, Topic, key, wait_until

PACKAGE = 'afm_emulator'
SHARE = Path(roslib.packages.get_pkg_dir(PACKAGE))

# the paper's values, from which the expectations of the tests are made
TAU_S = 2 * 3.141592653589793 / 40e3
SPEED_UNIT = 0.52e-9 / TAU_S     # m/s for eta = 1
ENERGY_UNIT = 408e-12 * SPEED_UNIT ** 2
FRICTION_UNIT = 408e-12 / TAU_S  # kg/s for a K_f of 1 m_tip/tau


def find(kind, package=PACKAGE):
    """A program of a package."""
    return roslib.packages.find_node(package, kind)[0]


class Process:
    """A child whose output is kept, line by line as it is written."""

    def __init__(self, command, env=None, **options):
        self.log = tempfile.TemporaryFile()
        self.child = subprocess.Popen(command, stdout=self.log, stderr=subprocess.STDOUT,
                                      env=dict(env or os.environ, PYTHONUNBUFFERED='1'), **options)

    def output(self):
        """Read without a seek: the child writes at the same offset."""
        return os.pread(self.log.fileno(), os.fstat(self.log.fileno()).st_size, 0).decode(errors='replace')

    def wait(self, deadline_s=15.0):
        return self.child.wait(timeout=deadline_s * PATIENCE)

    def stop(self, with_signal=signal.SIGINT):
        self.child.send_signal(with_signal)
        return self.wait()

    def halt(self):
        """SIGSTOP; its threads stop one after another, and one that goes on might still answer."""
        self.child.send_signal(signal.SIGSTOP)
        threads = Path('/proc/%d/task' % self.child.pid)
        wait_until(lambda: all((thread / 'stat').read_text().rpartition(')')[2].split()[0] == 'T'
                               for thread in threads.iterdir()), 'all threads stand still')

    def clean_up(self):
        """Asked first, so that the master forgets it: the address of a dead node can hide that of its heir from a
        subscriber."""
        try:
            if self.child.poll() is None:
                self.stop()
        except (subprocess.TimeoutExpired, AssertionError):
            self.child.kill()
            self.child.wait()
        print(self.output())


class Launch(Process):
    """roslaunch. Interrupted while it still starts a node it takes 10 to 20 s to end, so stop() waits until all have
    started."""

    def __init__(self, *arguments, env=None):
        super().__init__(['roslaunch'] + [str(argument) for argument in arguments], env)

    def has_started(self):
        """Every node that it lists is known to the master, or has ended."""
        text = self.output()
        spaces = re.findall(r'^  (/\S*)\n((?:    .*\n?)*)', text.partition('\nNODES\n')[2].partition('\n\n')[0], re.M)
        names = [space.rstrip('/') + '/' + name for space, nodes in spaces
                 for name in re.findall(r'^    (\S+) \(', nodes, re.M)]
        ended = re.findall(r'\[([^\s[]+)-\d+\] process has', text)
        return bool(names) and all(name.lstrip('/') in ended or is_known(name) for name in names)

    def stop(self, with_signal=signal.SIGINT):
        wait_until(lambda: self.child.poll() is not None or self.has_started(), 'roslaunch has started all nodes')
        return super().stop(with_signal)


class Emulators(Launch):
    """One for each of these arguments of emulator.launch."""

    def __init__(self, each):
        self.file = tempfile.NamedTemporaryFile('w', suffix='.launch')
        arguments = (''.join('<arg name="%s" value="%s"/>' % item for item in one.items()) for one in each)
        self.file.write('<launch>%s</launch>' % ''.join(
            '<include file="$(find %s)/launch/emulator.launch">%s</include>' % (PACKAGE, one) for one in arguments))
        self.file.flush()
        super().__init__(self.file.name)


def is_known(node):
    """To the master, where there is one."""
    try:
        return xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI']).lookupNode('/test', node)[0] == 1
    except OSError:
        return False


class Emulator(Process):
    def __init__(self, parameters=None, **environment):
        set_parameters(parameters or {})
        super().__init__([find('emulator_node'), '__name:=' + NAMESPACE[1:]], env=dict(os.environ, **environment))
        self.publishers = {}

    def call(self, service, kind, **request):
        return call_service(NAMESPACE + '/' + service, kind, **request)

    def control(self, duration, drag_velocity=math.nan, rest_height=math.nan):
        return self.call('control', Control, duration=duration, drag_velocity=drag_velocity, rest_height=rest_height)

    def publisher(self, name):
        if name not in self.publishers:
            self.publishers[name] = rospy.Publisher(NAMESPACE + '/' + name, Float64, queue_size=1000, tcp_nodelay=True)
        wait_until(lambda: self.publishers[name].get_num_connections() > 0, 'the emulator listens to ' + name)
        return self.publishers[name]

    def drag(self, velocity):
        self.publisher('drag_velocity').publish(velocity)

    def set(self, **wanted):
        """Live parameters, as a client of dynamic_reconfigure does; returns those in force after that."""
        config = Config(doubles=[DoubleParameter(name, value) for name, value in wanted.items()])
        answer = self.call('set_parameters', Reconfigure, config=config)
        return {value.name: value.value for value in answer.config.doubles}

    def assert_alive(self):
        status = Topic('status')
        status.wait_for(what='a sign of life')
        status.close()
        assert self.child.poll() is None, 'the emulator has ended with code %s' % self.child.poll()


def set_parameters(parameters, node=NAMESPACE):
    """These and no others: the master remembers what was set for an earlier node of the same name."""
    if rospy.has_param(node):
        rospy.delete_param(node)
    if parameters:
        rospy.set_param(node, parameters)


def call_service(service, kind, **request):
    """The emulator advertises its services after its topics: who has heard of it may still have to wait."""
    rospy.wait_for_service(service, timeout=DEADLINE_S * PATIENCE)
    return rospy.ServiceProxy(service, kind)(**request)


def connected_to(topic):
    """Names of the nodes that the emulator is connected to and sends this topic."""
    _, _, uri = rospy.get_master().lookupNode(NAMESPACE)
    if not uri:
        return set()  # the emulator is being started again
    connections = xmlrpc.client.ServerProxy(uri).getBusInfo('test')[2]
    return {peer for _, peer, direction, _, name, *_ in connections if direction == 'o' and name == topic}


class NodeTest(unittest.TestCase):
    """Leaves nothing behind."""

    def setUp(self):
        self.addCleanup(Topic.close_all, but=Topic.all_open())

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

    def launch(self, file, env=None, **arguments):
        """A file of the package."""
        return self.start(Launch(PACKAGE, file, *('%s:=%s' % item for item in arguments.items()), env=env))

    def record(self, environment=(), **parameters):
        """An emulator that may record, or does with record=True, into self.directory."""
        self.directory = Path(self.temporary_directory())
        return self.start(Emulator(dict(parameters, bag_directory=str(self.directory)), **dict(environment)))

    def end(self, emulator):
        """It is alive, and ends well. Returns its bags."""
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        return sorted(str(path) for path in self.directory.iterdir())

    def temporary_directory(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        return directory.name


class EmulatorTest(NodeTest):
    """One emulator for all tests of the class, alive after each, which ends well. Each test begins in an epoch of its
    own."""
    parameters = {}

    @classmethod
    def setUpClass(cls):
        cls.emulator, cls.epoch = Emulator(cls.parameters), 0
        cls.topics = {name: Topic(name) for name in TOPICS}
        for topic in cls.topics.values():
            topic.wait_for_connection()

    @classmethod
    def tearDownClass(cls):
        Topic.close_all()
        code = cls.emulator.stop() if cls.emulator.child.poll() is None else cls.emulator.child.returncode
        cls.emulator.clean_up()
        assert code == 0, 'the emulator ended with code %s' % code

    def setUp(self):
        super().setUp()
        self.begin()

    def tearDown(self):
        self.emulator.assert_alive()

    def begin(self, paused=False):
        """A new epoch, of which the topics hold the messages: those that an epoch begins with have come."""
        self.pause(paused)
        self.assertTrue(self.emulator.call('reset', Trigger).success)
        type(self).epoch += 1
        for topic in self.topics.values():
            topic.forget_before(self.epoch)
        for name in ('status', 'applied', 'snapshot', 'configuration'):
            self.topics[name].wait_for(lambda m: m.epoch == self.epoch, 'a new epoch')
        for topic in self.topics.values():
            topic.forget_before(self.epoch)

    def pause(self, paused):
        self.assertTrue(self.emulator.call('pause', SetBool, data=paused).success)

    def step(self, **how_far):
        """Returns the time reached."""
        answer = self.emulator.call('step', Step, **how_far)
        self.assertTrue(answer.success, answer.message)
        return answer.time

    def stepped(self, tau):
        """Steps, and waits until that has come."""
        end = self.step(tau=tau)
        friction = self.topics['friction'].wait_for(lambda m: key(m.time) == key(end), 'what was stepped')
        for name in ('deflection', 'impacts'):
            self.topics[name].wait_for(lambda m: m.header.seq == friction.header.seq, 'of the same batch')
        return friction

    def drag(self, eta):
        """Returns the message that says when it took effect."""
        count = len(self.topics['applied'].messages)
        self.emulator.drag(eta * SPEED_UNIT)
        return self.topics['applied'].wait_for(
            lambda m: m.cause == 'drag_velocity' and m.drag_velocity == eta * SPEED_UNIT, 'eta = %g' % eta, count)

    def status_now(self):
        return self.topics['status'].wait_for_next()

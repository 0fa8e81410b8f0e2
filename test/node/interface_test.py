"""What the nodes advertise is what docs/interface.md lists: names, types, and which topics are latched."""
import re

import rosgraph
import rospy
import rosservice

from emulator_under_test import PACKAGE, SHARE, EmulatorTest, Process
from topics import NAMESPACE, wait_until

ROW = re.compile(r'^\| (in|out) \| `(\S+)` \| (\w+/\w+) \| ?(yes|no|) ?\|', re.M)
SERVICE = re.compile(r'^\| `(~\w+)` \| (\w+/\w+) \|', re.M)
VIEW = '/afm_view'
ALL_NODES_HAVE = ('/rosout', 'get_loggers', 'set_logger_level')  # of roscpp's own


def document():
    return (SHARE / 'docs' / 'interface.md').read_text()


def resolved(name):
    return NAMESPACE + name.replace('~', '/') if name.startswith('~') else name


def listed(direction):
    return {resolved(name): (kind, latched) for way, name, kind, latched in ROW.findall(document()) if way == direction}


class Interface(EmulatorTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.view = Process(['roslaunch', PACKAGE, 'view.launch', 'rviz:=false'])
        cls.master = rosgraph.Master('/interface_test')

    @classmethod
    def tearDownClass(cls):
        cls.view.clean_up()
        super().tearDownClass()

    def setUp(self):
        super().setUp()
        wait_until(lambda: VIEW + '/markers' in self.names(0, VIEW), 'the view advertises its markers')

    def names(self, part, *nodes):
        """Part 0, 1, 2 of the state of the master: what these nodes publish, subscribe to, and serve."""
        return {name for name, owners in self.master.getSystemState()[part] if set(nodes) & set(owners)
                and not name.endswith(ALL_NODES_HAVE)}

    def assert_come_to(self, wanted, part, *nodes):
        """Nodes advertise one name after another."""
        try:
            wait_until(lambda: self.names(part, *nodes) == wanted, 'all is advertised')
        except AssertionError:
            self.assertEqual(self.names(part, *nodes), wanted)

    def test_topics(self):
        types = dict(self.master.getTopicTypes())
        out = listed('out')
        self.assertGreater(len(out), 10)
        self.assert_come_to(set(out), 0, NAMESPACE, VIEW)
        self.assert_come_to(set(listed('in')), 1, NAMESPACE)
        for name, (kind, _) in out.items():
            self.assertEqual(types[name], kind, name)

    def test_latched(self):
        latched = {}
        subscribers = [rospy.Subscriber(name, rospy.AnyMsg, lambda m, name=name: latched.setdefault(
            name, m._connection_header['latching'] == '1')) for name in listed('out')]
        wait_until(lambda: len(latched) == len(subscribers), 'a message on every topic')
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual(latched, {name: said == 'yes' for name, (_, said) in listed('out').items()})

    def test_services(self):
        services = {resolved(name): kind for name, kind in SERVICE.findall(document())}
        self.assert_come_to(set(services), 2, NAMESPACE)
        for name, kind in services.items():
            self.assertEqual(rosservice.get_service_type(name), kind, name)

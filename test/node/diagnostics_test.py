"""What a running node comes to is on /diagnostics. diagnosis_test.cpp tests what is said of each state."""
import math

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from emulator_under_test import SPEED_UNIT, Emulator, NodeTest
from topics import NAMESPACE, Topic, wait_until

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


class Diagnostics(NodeTest):
    def run_emulator(self, **parameters):
        self.emulator = self.start(Emulator(dict({'sample_rate_hz': 20000.0}, **parameters)))
        self.diagnostics = Topic('/diagnostics', DiagnosticArray)
        self.diagnostics.wait_for_connection()
        Topic('deflection').wait_for()
        self.found = 0

    def end(self):
        self.emulator.assert_alive()
        self.assertEqual(self.emulator.stop(), 0)

    def expect(self, name, level, reason=''):
        """The next entry that is so, behind the message that was found last."""
        def found():
            return next(((i, s) for i, m in enumerate(self.diagnostics.messages) for s in m.status if i >= self.found
                         and s.name == 'afm: ' + name and s.level == level and reason in s.message), None)
        self.found, entry = wait_until(found, '%s: level %d, "%s"' % (name, level, reason))
        return {value.key: value.value for value in entry.values}

    def test_well_then_refusing_then_silent(self):
        self.run_emulator(command_timeout_s=2.0, batch_rate_hz=50.0, bag_directory=self.temporary_directory())
        pace = self.expect('emulation', OK, 'running')
        self.assertAlmostEqual(float(pace['real-time factor']), 1.0, delta=0.5)
        self.assertTrue(pace['scheduler'].startswith(('fifo', 'normal')))
        self.expect('numerics', OK)
        self.expect('recording', OK, 'not recording')
        self.expect('commands', WARN, 'no drag velocity for 2 s')
        self.emulator.call('reset', Trigger)
        self.expect('commands', OK)
        self.expect('commands', WARN, 'no drag velocity for 2 s')
        self.emulator.drag(SPEED_UNIT)
        self.expect('commands', OK)
        self.emulator.drag(math.nan)
        self.assertEqual(self.expect('commands', WARN,
                                     'drag_velocity = nan m/s: must be finite')['refused commands'], '1')
        self.emulator.set(rest_height_m=6e-11)
        reported = self.expect('commands', WARN, 'rest_height_m = 6e-11: ')
        self.assertEqual(reported['refused changes of parameters'], '1')
        self.end()

    def test_more_commands_than_can_wait(self):
        self.run_emulator(batch_rate_hz=1.0)
        flood = rospy.Publisher(NAMESPACE + '/drag_velocity', Float64, queue_size=10000, tcp_nodelay=True)
        wait_until(lambda: flood.get_num_connections() > 0, 'connected')

        def refused():
            for _ in range(500):
                flood.publish(SPEED_UNIT)
            return 'too many commands are waiting' in self.emulator.output()
        wait_until(refused, 'overload')
        self.expect('commands', ERROR, 'too many commands are waiting')
        flood.unregister()
        self.end()

"""Under load (200 commands a second, 20 subscribers, one that never reads, every core busy) model time keeps up and the
recording is whole."""
import multiprocessing
import random
import subprocess
import sys
import time

import rospy

import checks
from emulator_under_test import SPEED_UNIT, TAU_S, NodeTest
from tcpros import BareSubscriber, Drain
from topics import Topic, wait_until

COMMANDS, RATE_HZ, SUBSCRIBERS = 600, 200, 20


class Load(NodeTest):
    def setUp(self):
        super().setUp()
        self.emulator = self.record(record=True)
        self.status, self.applied = Topic('status'), Topic('applied')
        self.applied.wait_for_connection()
        self.emulator.drag(SPEED_UNIT)
        self.applied.wait_for(lambda m: m.drag_velocity == SPEED_UNIT, 'a first command')

    def keep_cores_busy(self):
        for _ in range(multiprocessing.cpu_count()):
            burner = subprocess.Popen([sys.executable, '-c', 'while True: pass'])
            self.addCleanup(burner.wait)
            self.addCleanup(burner.kill)

    def send_commands(self):
        chance, rate, publisher = random.Random(7), rospy.Rate(RATE_HZ), self.emulator.publisher('drag_velocity')
        for _ in range(COMMANDS):
            publisher.publish(chance.choice((-1, 1)) * 10 ** chance.uniform(-4, 1) * SPEED_UNIT)
            rate.sleep()

    def test_load(self):
        drain = Drain([BareSubscriber('deflection', '/bare_%d' % i) for i in range(SUBSCRIBERS)])
        self.addCleanup(drain.stop)
        deaf = BareSubscriber('deflection', '/deaf')
        self.addCleanup(deaf.socket.close)
        self.keep_cores_busy()
        begin, since = self.status.wait_for_next(), time.monotonic()
        before = dict(drain.bytes)
        self.send_commands()
        wait_until(lambda: len(self.applied.messages) == COMMANDS + 2, 'every command is applied')
        status = self.status.wait_for_next(lambda m: m.lag < 0.5, 'not late in the end')
        wall_s, model_s = time.monotonic() - since, (status.time.tau - begin.time.tau) * TAU_S
        print('%d commands in %.2f s; model time %.2f s; worst lag %.4f s, %d late batches; scheduler: %s' % (
            COMMANDS, wall_s, model_s, status.worst_lag, status.late_batches, status.scheduler))
        self.assertLess(abs(model_s - wall_s), 1.0)
        self.assertEqual((status.refused_commands, status.search_failures), (0, 0))
        self.assertGreater(status.worst_lag, 0.0)
        for s, count in drain.bytes.items():
            self.assertGreater(count - before[s], 1000000, 'a subscriber got less than a third of a second')
        checks.assert_identical(self, *self.end(self.emulator))

#!/usr/bin/python3
"""pair.launch runs two emulators on one master, which know nothing of each other: each obeys its own commands alone."""
import unittest

import rospy
from std_msgs.msg import Float64

from emulator_under_test import SPEED_UNIT, run
from topics import Topic, wait_until

START = {'left': 3.4, 'right': 2.0}  # eta of their scenes


class Tip:
    def __init__(self, side):
        self.side, name, topics = side, '/%s/afm/' % side, ('applied', 'deflection', 'friction')
        self.topics = {topic: Topic(name + topic) for topic in topics}
        self.drag_publisher = rospy.Publisher(name + 'drag_velocity', Float64, queue_size=10)
        for topic in self.topics.values():
            topic.wait_for_connection()

    def drag(self, eta):
        wait_until(lambda: self.drag_publisher.get_num_connections() == 1, self.side + ': listens')
        self.drag_publisher.publish(eta * SPEED_UNIT)
        self.topics['friction'].wait_for(lambda m: m.drag_velocity == eta * SPEED_UNIT, 'eta = %g' % eta)

    def velocities(self):
        return [m.drag_velocity / SPEED_UNIT for m in self.topics['applied'].messages]

    def wait_for_samples(self, count):
        self.topics['applied'].wait_for()
        last = self.topics['deflection'].wait_for_next().first_sample
        self.topics['deflection'].wait_for(lambda m: m.first_sample > last + count, '%d more samples' % count)


class Pair(unittest.TestCase):
    def setUp(self):
        self.addCleanup(Topic.close_all)
        self.left, self.right = Tip('left'), Tip('right')

    def test_each_obeys_its_own_commands(self):
        for tip in (self.left, self.right):
            tip.wait_for_samples(20000)
            self.assertEqual([round(v, 9) for v in tip.velocities()], [START[tip.side]])
        self.left.drag(1.5)
        self.right.wait_for_samples(40000)  # a fifth of a second in which a command gone astray would show
        self.assertEqual([round(v, 9) for v in self.right.velocities()], [2.0])
        self.right.drag(-2.5)
        self.left.wait_for_samples(40000)
        self.assertEqual([round(v, 9) for v in self.left.velocities()], [3.4, 1.5])
        self.assertEqual([round(v, 9) for v in self.right.velocities()], [2.0, -2.5])


if __name__ == '__main__':
    run(Pair)

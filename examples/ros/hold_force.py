#!/usr/bin/python3
"""A controller: holds the mean lateral force by commanding ~rest_height, the normal load.

Friction is not monotonic in the load, so the height stays within limits between which force rises as the tip is lowered
(docs/temperature.md, "Load"). Publishes the measured force [N] on ~measured_force and the height [m] on
~commanded_height.
Parameters: emulator, force [N], gain [m/N], lowest and highest height [m], settle_s and window_s of model time."""
from afm_emulator import ending  # before all else
import rospy
from afm_emulator import Client, number_parameter
from std_msgs.msg import Float64


def main():
    ending.init_node('hold_force')
    setpoint = number_parameter('force', 60e-12)
    gain = number_parameter('gain', 1.0)  # half of 1 / (dF / d height), which is 0.45 N/m at eta = 3.4
    lowest, highest = number_parameter('lowest', -0.33e-9), number_parameter('highest', -0.03e-9)
    settle, window = number_parameter('settle_s', 0.02), number_parameter('window_s', 0.1)
    measured = rospy.Publisher('~measured_force', Float64, queue_size=10)
    commanded = rospy.Publisher('~commanded_height', Float64, queue_size=10)
    tip = Client(rospy.get_param('~emulator', 'afm'))
    height = min(max(tip.applied.rest_height_m, lowest), highest)
    while not rospy.is_shutdown():
        force = tip.mean_force(window, settle, rest_height=height)
        measured.publish(force)
        commanded.publish(height)
        rospy.loginfo('force %.1f pN, height %.1f pm', 1e12 * force, 1e12 * height)
        before, height = height, min(max(height - gain * (setpoint - force), lowest), highest)  # lower presses harder
        if height == before:
            rospy.logwarn('the height is at its limit; the force is %.1f pN, not %.1f', 1e12 * force, 1e12 * setpoint)


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSException:  # the node is shut down, and its topics are closed
        pass

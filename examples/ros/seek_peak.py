#!/usr/bin/python3
"""A controller: seeks the drag velocity with the greatest friction by commanding ~drag_velocity (extremum seeking).

Measures the mean lateral force a little below and a little above the present speed, and goes to where it is greater.
The step is proportional to the relative difference, so it vanishes at the peak. Publishes the speed [m/s] on ~speed.
Parameters: emulator, start, dither, gain, lowest and highest speed [m/s], settle_s and window_s of model time."""
from afm_emulator import ending  # before all else
import rospy
from afm_emulator import Client, number_parameter
from std_msgs.msg import Float64

ETA = 3.3104228e-6  # m/s of eta = 1 (mica), for the defaults


def main():
    ending.init_node('seek_peak')
    speed = number_parameter('start', 1.75 * ETA)
    dither, gain = number_parameter('dither', 0.05 * ETA), number_parameter('gain', 0.2 * ETA)
    lowest, highest = number_parameter('lowest', 1.2 * ETA), number_parameter('highest', 3.0 * ETA)
    settle, window = number_parameter('settle_s', 0.02), number_parameter('window_s', 0.1)
    published = rospy.Publisher('~speed', Float64, queue_size=10)
    tip = Client(rospy.get_param('~emulator', 'afm'))
    while not rospy.is_shutdown():
        below, above = (tip.mean_force(window, settle, drag_velocity=v) for v in (speed - dither, speed + dither))
        published.publish(speed)
        rospy.loginfo('speed %.3f um/s: force %.1f pN below it, %.1f pN above', 1e6 * speed, 1e12 * below, 1e12 * above)
        total = abs(below) + abs(above)
        if total > 0:
            speed = min(max(speed + gain * (above - below) / total, lowest), highest)


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSException:  # the node is shut down, and its topics are closed
        pass

#!/usr/bin/python3
"""A subscriber: checks that no sample is lost, and plots the lateral force of each batch against model time, in a
window, or with the parameter output in a file.
Parameters: emulator, duration [s of wall time], output. Exit code 1 if samples were lost or none came."""
from afm_emulator import ending  # before all else
import math
import sys
import time

import matplotlib
import numpy
import rospy
from afm_emulator.msg import Configuration, Deflection


class Recorder:
    def __init__(self, emulator):
        self.configuration, self.next_sample, self.lost = None, None, 0
        self.times, self.forces = [], []
        rospy.Subscriber(emulator + '/configuration', Configuration, self.take_configuration)
        rospy.Subscriber(emulator + '/deflection', Deflection, self.take, tcp_nodelay=True, buff_size=1 << 22)

    def take_configuration(self, configuration):
        self.configuration = configuration

    def take(self, batch):
        c = self.configuration
        if c is None or batch.epoch != c.epoch:
            self.next_sample = None
            return
        if self.next_sample is not None and batch.first_sample > self.next_sample:
            self.lost += batch.first_sample - self.next_sample
        self.next_sample = batch.first_sample + len(batch.lateral)
        if len(batch.lateral):
            self.times.append((batch.time.tau + batch.time.phase) * 2 * math.pi / c.omega_v_rad_per_s)
            force = -c.tip_mass_kg * c.omega_h_rad_per_s ** 2 * float(numpy.mean(batch.lateral))
            if not any(batch.lateral):  # of the hammer, whose spring along x is rigid
                force = batch.lateral_impulse / (len(batch.lateral) * batch.sample_period)
            self.forces.append(force)


def main():
    ending.init_node('plot_force')
    output = rospy.get_param('~output', '')
    if output:
        matplotlib.use('Agg')
    import matplotlib.pyplot as plt  # after the choice of how to draw
    recorder = Recorder(rospy.get_param('~emulator', 'afm'))
    # wall time: with use_sim_time and without a clock rospy.sleep() would last for ever
    end = time.monotonic() + rospy.get_param('~duration', 5.0)
    while time.monotonic() < end and not rospy.is_shutdown():
        time.sleep(0.05)
    count = min(len(recorder.times), len(recorder.forces))
    print('%d batches, %d samples lost' % (count, recorder.lost))
    plt.plot(recorder.times[:count], 1e12 * numpy.array(recorder.forces[:count]), linewidth=0.8)
    plt.xlabel('model time / s')
    plt.ylabel('mean lateral force of a batch / pN')
    if output:
        plt.savefig(output, dpi=150)
    else:
        plt.show()
    return 1 if recorder.lost or not count else 0


if __name__ == '__main__':
    sys.exit(main())

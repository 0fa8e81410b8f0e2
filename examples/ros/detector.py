#!/usr/bin/python3
"""A detector: what an instrument would give of ~deflection. Light on a photodiode has a calibration, white noise and a
range, and a converter has bits. Publishes volts on ~volts (std_msgs/Float64MultiArray, the two channels vertical and
lateral one after the other, a message for each batch).
Parameters: emulator, vertical_v_per_nm, lateral_v_per_nm, noise_v_per_sqrt_hz, range_v, bits, seed."""
from afm_emulator import ending  # before all else
import numpy
import rospy
from afm_emulator import number_parameter
from afm_emulator.msg import Deflection
from std_msgs.msg import Float64MultiArray, MultiArrayDimension


class Detector:
    def __init__(self):
        self.v_per_nm = numpy.array([[number_parameter('vertical_v_per_nm', 0.05)],
                                     [number_parameter('lateral_v_per_nm', 0.01)]])
        self.noise = number_parameter('noise_v_per_sqrt_hz', 5e-6)  # 0.1 pm per root Hz of vertical deflection
        span = 2 * number_parameter('range_v', 10.0)
        codes = 2 ** rospy.get_param('~bits', 16)
        self.step, self.codes = span / codes, (-codes // 2, codes // 2 - 1)
        self.random = numpy.random.default_rng(rospy.get_param('~seed', 1))
        self.volts = rospy.Publisher('~volts', Float64MultiArray, queue_size=100)
        rospy.Subscriber(rospy.get_param('~emulator', 'afm') + '/deflection', Deflection, self.measure,
                         tcp_nodelay=True, buff_size=1 << 22)

    def measure(self, batch):
        deflection = 1e9 * numpy.array([batch.vertical, batch.lateral])
        # white noise up to half the sample rate: its variance is the density squared times that bandwidth
        noise = self.noise * (0.5 / batch.sample_period) ** 0.5 * self.random.standard_normal(deflection.shape)
        codes = numpy.clip(numpy.round((self.v_per_nm * deflection + noise) / self.step), *self.codes)
        message = Float64MultiArray()
        rows, columns = codes.shape
        message.layout.dim = [MultiArrayDimension('channel', rows, rows * columns),
                              MultiArrayDimension('sample', columns, columns)]
        message.data = (codes * self.step).ravel()
        self.volts.publish(message)


if __name__ == '__main__':
    ending.init_node('detector')
    detector = Detector()
    rospy.spin()

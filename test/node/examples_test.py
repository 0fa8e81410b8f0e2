"""The example nodes do what they are for, started by their launch files as a user starts them."""
import csv
import re
import subprocess
from pathlib import Path

import roslib.packages
import rospy
from std_msgs.msg import Float64MultiArray

from emulator_under_test import PACKAGE, SPEED_UNIT, Emulator, NodeTest, Process
from topics import PATIENCE, Topic, wait_until

SLOW_MOTION = 1 / PATIENCE  # subscribers under a sanitizer need it to lose nothing


class Examples(NodeTest):
    def end(self, process):
        """Ctrl-C ends all of it."""
        self.assertIn(process.stop(), (0, -2), process.output())

    def test_the_detector_gives_volts_with_noise_and_steps(self):
        self.check_detector('python')

    def test_the_detector_in_cpp_too(self):
        self.check_detector('cpp')

    def check_detector(self, language):
        volts, deflection = Topic('/detector/volts', Float64MultiArray), Topic('deflection')
        example = self.launch('detector.launch', language=language)
        wait_until(lambda: len(volts.messages) > 20 and len(deflection.messages) > 5, 'volts, once all has started')
        message = volts.messages[-1]
        rows, columns = (dimension.size for dimension in message.layout.dim)
        self.assertEqual((rows, columns, len(message.data)), (2, 2000, 4000))
        step = 20.0 / 2 ** 16
        self.assertTrue(all(abs(v / step - round(v / step)) < 1e-6 for v in message.data))
        # 5 uV per root Hz to 100 kHz: 1.6 mV, that is 5 steps, on 50 mV / nm of a deflection of 0.1 nm
        rms = {'volts': self.rms(message.data[:columns]),
               'deflection': self.rms([50e6 * v for v in deflection.messages[-1].vertical])}
        self.assertLess(abs(rms['volts'] / rms['deflection'] - 1), 0.5, rms)
        self.end(example)

    @staticmethod
    def rms(values):
        return (sum(v * v for v in values) / len(values)) ** 0.5

    def test_a_plot_and_a_watch_for_gaps_even_without_a_clock(self):
        rospy.set_param('/use_sim_time', True)  # and nobody publishes /clock
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        output = Path(self.temporary_directory()) / 'force.png'
        example = self.launch('plot_force.launch', duration=5.0, output=output, time_scale=SLOW_MOTION)
        example.wait(deadline_s=60.0)
        text = example.output()
        self.assertGreater(output.stat().st_size, 10000)
        self.assertRegex(text, r'\b\d\d+ batches, 0 samples lost')
        self.assertRegex(text, r'\d{4,} samples and \d+ impacts; lost: 0 and 0')

    def test_a_commander_in_cpp(self):
        self.start(Emulator({'temperature_k': 300.0, 'quality_factor': 100.0, 'time_scale': SLOW_MOTION}))
        binary = roslib.packages.find_node(PACKAGE, 'watch_and_command')[0]
        example = self.start(Process([binary, repr(2 * SPEED_UNIT), repr(3 * SPEED_UNIT), '_hold_s:=2.0']))
        self.assertEqual(example.wait(deadline_s=30.0), 0)
        eta = [float(value) for value in re.findall(r'eta ([\d.]+)', example.output())]
        self.assertEqual([round(value, 3) for value in eta], [2.0, 3.0])

    def test_the_loop_delay_is_measured(self):
        self.start(Emulator({'batch_rate_hz': 100.0}))
        binary = roslib.packages.find_node(PACKAGE, 'loop_delay')[0]
        done = subprocess.run([binary, '_commands:=40'], stdout=subprocess.PIPE, universal_newlines=True,
                              timeout=60 * PATIENCE)
        self.assertEqual(done.returncode, 0)
        row, = csv.DictReader(line for line in done.stdout.splitlines() if not line.startswith('['))
        self.assertEqual((row['batch rate / Hz'], row['commands'], row['lost']), ('100', '40', '0'))
        applied, seen = float(row['applied: median / ms']), float(row['in a batch: median / ms'])
        # a command waits for the end of a batch of 10 ms, 5 ms in the median; then the batch that it moves comes at
        # once
        self.assertGreater(applied, 2.0)
        self.assertGreaterEqual(seen, applied)

"""The example nodes do what they are for, started by their launch files as a user starts them."""
import csv
import subprocess
from pathlib import Path

import rospy
from std_msgs.msg import Float64MultiArray

from emulator_under_test import Emulator, NodeTest, Process, find
from topics import PATIENCE, Topic, wait_until

SLOW_MOTION = 1 / PATIENCE  # subscribers under a sanitizer need it to lose nothing


class Examples(NodeTest):
    def end(self, process):
        """Ctrl-C ends all of it."""
        self.assertIn(process.stop(), (0, -2), process.output())

    def test_the_detector_gives_volts_with_noise_and_steps(self):
        volts, deflection = Topic('/detector/volts', Float64MultiArray), Topic('deflection')
        example = self.launch('detector.launch')
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

    def test_a_plot_without_gaps_even_without_a_clock(self):
        rospy.set_param('/use_sim_time', True)  # and nobody publishes /clock
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        output = Path(self.temporary_directory()) / 'force.png'
        example = self.launch('plot_force.launch', duration=5.0, output=output, time_scale=SLOW_MOTION)
        example.wait(deadline_s=60.0)
        text = example.output()
        self.assertGreater(output.stat().st_size, 10000)
        self.assertRegex(text, r'\b\d\d+ batches, 0 samples lost')

    def test_a_text_is_no_number(self):
        """The controller once held its default in place of 8e-12, which is a text in YAML."""
        rospy.set_param('/hold_force', {'force': '8e-12'})
        self.addCleanup(rospy.delete_param, '/hold_force')
        for program, text in (('hold_force', '8e-12'), ('hold_force.py', "'8e-12'")):
            controller = self.start(Process([find(program)]))
            self.assertEqual(controller.wait(60.0), 1)
            self.assertIn('/hold_force/force = %s: must be a number; YAML needs 1.0e-12' % text, controller.output())

    def test_the_loop_delay_is_measured(self):
        self.start(Emulator({'batch_rate_hz': 100.0}))
        done = subprocess.run([find('loop_delay'), '_commands:=40'], stdout=subprocess.PIPE, universal_newlines=True,
                              timeout=60 * PATIENCE)
        self.assertEqual(done.returncode, 0)
        row, = csv.DictReader(line for line in done.stdout.splitlines() if not line.startswith('['))
        self.assertEqual((row['batch rate / Hz'], row['commands']), ('100', '40'))
        # a command waits for the end of a batch of 10 ms, 5 ms in the median
        self.assertGreater(float(row['median / ms']), 2.0)

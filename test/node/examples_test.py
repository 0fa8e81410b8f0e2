#!/usr/bin/python3
"""The example nodes do what they are for, started by their launch files as a user starts them."""
import csv
import re
import subprocess
from pathlib import Path

import roslib.packages
from std_msgs.msg import Float64, Float64MultiArray

from emulator_under_test import PACKAGE, SPEED_UNIT, Emulator, NodeTest, Process, run
from topics import PATIENCE, Topic, wait_until

FORCE = 60e-12                   # set in hold_force.launch [N]
PEAK = (1.93, 2.0)               # of the friction force over eta at 300 K and Q = 100, by friction_curve: 1.95 to 1.97


def last(topic, count):
    return [message.data for message in topic.messages[-count:]]


class Examples(NodeTest):
    def end(self, process):
        """Ctrl-C ends all of it."""
        self.assertIn(process.stop(), (0, -2), process.output())

    def test_a_controller_holds_the_force(self):
        forces, heights, applied = (Topic('/hold_force/measured_force', Float64), Topic('/hold_force/commanded_height', Float64),
                                    Topic('applied_parameters'))
        example = self.launch('hold_force.launch')
        wait_until(lambda: len(forces.messages) > 10 and max(abs(f / FORCE - 1) for f in last(forces, 8)) < 0.1,
                   'eight measured forces in a row within a tenth of the one set', deadline_s=60.0)
        # it was not there from the beginning: at zero load the force is 9 pN
        self.assertLess(forces.messages[0].data, 0.5 * FORCE)
        self.assertTrue(all(-0.25e-9 < height < -0.15e-9 for height in last(heights, 5)), last(heights, 5))
        self.assertAlmostEqual(applied.messages[-1].rest_height_m, heights.messages[-1].data, delta=0.02e-9)
        # and the emulator's own mean, of all batches since some command, agrees
        friction = Topic('friction')
        friction.wait_for(lambda m: m.drag_velocity > 0 and abs(m.mean_lateral_force / FORCE - 1) < 0.15, 'the emulator agrees')
        self.end(example)

    def test_a_controller_finds_the_peak(self):
        speeds = Topic('/seek_peak/speed', Float64)
        example = self.launch('seek_peak.launch')
        wait_until(lambda: len(speeds.messages) > 8 and all(PEAK[0] < v / SPEED_UNIT < PEAK[1] for v in last(speeds, 5)),
                   'five speeds in a row at the peak', deadline_s=60.0)
        self.assertLess(speeds.messages[0].data / SPEED_UNIT, 1.8)
        self.end(example)

    def test_from_the_other_side_too(self):
        speeds = Topic('/seek_peak/speed', Float64)
        example = self.launch('seek_peak.launch', start=2.2 * SPEED_UNIT)
        wait_until(lambda: len(speeds.messages) > 8 and all(PEAK[0] < v / SPEED_UNIT < PEAK[1] for v in last(speeds, 5)),
                   'five speeds in a row at the peak', deadline_s=60.0)
        self.end(example)

    def test_the_detector_gives_volts_with_noise_and_steps(self):
        volts, deflection = Topic('/detector/volts', Float64MultiArray), Topic('deflection')
        example = self.launch('detector.launch')
        volts.wait_for_more(20)
        deflection.wait_for_more(5)
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

    def test_a_plot_and_a_watch_for_gaps(self):
        output = Path(self.temporary_directory()) / 'force.png'
        example = self.launch('plot_force.launch', duration=1.5, output=output)
        example.wait(deadline_s=60.0)
        text = example.output()
        self.assertGreater(output.stat().st_size, 10000)
        self.assertRegex(text, r'\b\d\d+ batches, 0 samples lost')
        self.assertRegex(text, r'\d{4,} samples and \d+ impacts; lost: 0 and 0')

    def test_a_commander_in_cpp(self):
        self.start(Emulator({'temperature_k': 300.0, 'quality_factor': 100.0}))
        binary = roslib.packages.find_node(PACKAGE, 'watch_and_command')[0]
        example = self.start(Process([binary, '_drag_velocities:=[%r, %r]' % (2 * SPEED_UNIT, 3 * SPEED_UNIT), '_hold_s:=0.7']))
        self.assertEqual(example.wait(deadline_s=30.0), 0)
        eta = [float(value) for value in re.findall(r'eta ([\d.]+)', example.output())]
        self.assertEqual([round(value, 3) for value in eta], [2.0, 3.0])

    def test_the_loop_delay_is_measured(self):
        self.start(Emulator({'batch_rate_hz': 100.0}))
        binary = roslib.packages.find_node(PACKAGE, 'loop_delay')[0]
        done = subprocess.run([binary, '_commands:=40'], stdout=subprocess.PIPE, universal_newlines=True, timeout=60 * PATIENCE)
        self.assertEqual(done.returncode, 0)
        row, = csv.DictReader(line for line in done.stdout.splitlines() if not line.startswith('['))
        self.assertEqual((row['batch rate / Hz'], int(row['commands']) + int(row['lost'])), ('100', 40))
        applied, seen = float(row['applied: median / ms']), float(row['in a batch: median / ms'])
        # a command waits for the end of a batch of 10 ms, 5 ms in the middle, and the batch that it moves lasts 10 ms more
        self.assertGreater(applied, 0.5)
        self.assertGreater(seen, applied + 5.0)


if __name__ == '__main__':
    run(Examples)

#!/usr/bin/python3
"""The example controllers reach what they are for, started by their launch files as a user starts them.
usage: controllers_test.py python|cpp"""
import sys

from std_msgs.msg import Float64

from emulator_under_test import SPEED_UNIT, NodeTest, run
from topics import Topic, wait_until

LANGUAGE = sys.argv[1]
FORCE = 60e-12      # set in hold_force.launch [N]
PEAK = (1.93, 2.0)  # of the friction force over eta at 300 K and Q = 100, by friction_curve: 1.95 to 1.97


def last(topic, count):
    return [message.data for message in topic.messages[-count:]]


class Controllers(NodeTest):
    def end(self, process):
        """Ctrl-C ends all of it."""
        self.assertIn(process.stop(), (0, -2), process.output())

    def test_a_controller_holds_the_force(self):
        forces, heights, applied = (Topic('/hold_force/measured_force', Float64), Topic('/hold_force/commanded_height', Float64),
                                    Topic('applied_parameters'))
        example = self.launch('hold_force.launch', language=LANGUAGE)
        wait_until(lambda: len(forces.messages) > 10 and max(abs(f / FORCE - 1) for f in last(forces, 8)) < 0.1,
                   'eight measured forces in a row within a tenth of the one set', deadline_s=60.0)
        # the scene begins at zero height, where the force is 9 pN (docs/data/load.csv)
        self.assertTrue(all(-0.25e-9 < height < -0.15e-9 for height in last(heights, 5)), last(heights, 5))
        self.assertAlmostEqual(applied.messages[-1].rest_height_m, heights.messages[-1].data, delta=0.02e-9)
        # and the emulator's own mean, of all batches since some command, agrees
        friction = Topic('friction')
        friction.wait_for(lambda m: m.drag_velocity > 0 and abs(m.mean_lateral_force / FORCE - 1) < 0.15, 'the emulator agrees')
        self.end(example)

    def test_a_controller_finds_the_peak_from_below(self):
        speeds = Topic('/seek_peak/speed', Float64)
        example = self.launch('seek_peak.launch', language=LANGUAGE)
        wait_until(lambda: len(speeds.messages) > 8 and all(PEAK[0] < v / SPEED_UNIT < PEAK[1] for v in last(speeds, 5)),
                   'five speeds in a row at the peak', deadline_s=60.0)
        self.end(example)

    def test_and_from_above(self):
        speeds = Topic('/seek_peak/speed', Float64)
        example = self.launch('seek_peak.launch', language=LANGUAGE, start=2.2 * SPEED_UNIT)
        wait_until(lambda: len(speeds.messages) > 8 and all(PEAK[0] < v / SPEED_UNIT < PEAK[1] for v in last(speeds, 5)),
                   'five speeds in a row at the peak', deadline_s=60.0)
        self.end(example)


if __name__ == '__main__':
    run(Controllers)

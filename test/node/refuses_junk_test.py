#!/usr/bin/python3
"""Commands that are no drag velocity are counted and change nothing."""
import math

from emulator_under_test import EmulatorTest, run
from topics import Topic

JUNK = [math.nan, math.inf, -math.inf, 1.0000001e-5, -1.0000001e-5, 1e300, -1e300]


class RefusesJunk(EmulatorTest):
    parameters = {'drag_velocity': 6.0e-6, 'max_drag_velocity': 1.0e-5}

    def setUp(self):
        super().setUp()
        self.applied, self.friction, self.status = Topic('applied_drag'), Topic('friction'), Topic('status')

    def test_junk_changes_nothing(self):
        self.applied.wait_for(lambda m: m.drag_velocity == 6.0e-6, 'the speed at start')
        for velocity in JUNK:
            self.emulator.drag(velocity)
        self.emulator.drag(-1.0e-5)  # the fastest there is; all that came before it has been judged when it is applied
        for topic in (self.applied, self.friction):
            topic.wait_for(lambda m: m.drag_velocity == -1.0e-5, 'the last command')
        self.assertEqual([m.drag_velocity for m in self.applied.messages], [6.0e-6, -1.0e-5])
        self.assertEqual({m.drag_velocity for m in self.friction.messages}, {6.0e-6, -1.0e-5})
        self.status.wait_for(lambda m: m.refused_commands >= len(JUNK), 'the refused are counted')
        self.assertEqual(self.status.wait_for_next().refused_commands, len(JUNK))

    def test_good_commands_are_not_counted(self):
        for velocity in (0.0, 1.0e-5, -3.0e-6):
            self.emulator.drag(velocity)
        self.applied.wait_for(lambda m: m.drag_velocity == -3.0e-6, 'the last command')
        self.assertEqual(self.status.wait_for_next().refused_commands, 0)


if __name__ == '__main__':
    run(RefusesJunk)

#!/usr/bin/python3
"""model: auto takes for every drag velocity the cheapest level that its tolerance allows, says which, and the recording
is repeated bit for bit."""
import math
from pathlib import Path

from std_srvs.srv import SetBool, Trigger

import bags
from checks import assert_identical
from emulator_under_test import ENERGY_UNIT, SPEED_UNIT, Emulator, NodeTest, run
from topics import Topic, key

HEAD = ('# parameters: gamma 0.7 cutoff %.12g frequency_ratio 6.25 amplitude 0.09615384615384616 rest_height 0\n'
        'eta,model,contact_tolerance,k_f_error,deflection_error,cost\n' % (1.66e-7 / SPEED_UNIT))
# At eta = 2 the hammer will do, at 3 bursts, at 4 every bounce; between them the finer
ROWS = [(2, 'hammer', 0.001, 0.01), (2, 'oscillator', 0.001, 0.0), (2, 'oscillator', 0, 0.0),
        (3, 'hammer', 0.001, 0.3), (3, 'oscillator', 0.001, 0.015), (3, 'oscillator', 0, 0.0),
        (4, 'hammer', 0.001, 0.4), (4, 'oscillator', 0.001, 0.1), (4, 'oscillator', 0, 0.0)]
HAMMER, BURSTS, EVERY = ('hammer', 0.001, 0.01), ('oscillator', 0.001, 0.015), ('oscillator', 0.0, 0.0)
UNKNOWN = ('oscillator', 0.002, math.nan)


def cost(model, tolerance):
    return 1 if model == 'hammer' else 2 if tolerance else 4


def reported(message):
    return (message.model, message.contact_tolerance, message.expected_error)


class Levels(NodeTest):
    def setUp(self):
        super().setUp()
        self.directory = Path(self.temporary_directory())
        self.table = self.directory / 'levels.csv'
        self.table.write_text(HEAD + ''.join(
            '%g,%s,%g,%g,0,%g\n' % (eta, model, tolerance, error, cost(model, tolerance))
            for eta, model, tolerance, error in ROWS))
        self.parameters = {'model': 'auto', 'tolerance': 0.02, 'level_table': str(self.table),
                           'contact_tolerance': 0.002, 'drag_velocity': 2 * SPEED_UNIT, 'record': True,
                           'bag_directory': str(self.directory / 'bags')}

    def assert_same(self, got, expected):
        self.assertEqual(repr(got), repr(expected))  # nan is nan

    def play(self):
        self.applied, self.status = Topic('applied'), Topic('status')
        self.emulator = self.start(Emulator(self.parameters))

    def drag(self, eta):
        count = len(self.applied.messages)
        self.emulator.drag(eta * SPEED_UNIT)
        return self.applied.wait_for(lambda m: abs(m.drag_velocity - eta * SPEED_UNIT) < 1e-15, begin=count)

    def set_parameter(self, name, value):
        count = len(self.applied.messages)
        self.emulator.set(**{name: value})
        return self.applied.wait_for(lambda m: getattr(m, name) == value, begin=count)

    def set_gamma(self, gamma):
        return self.set_parameter('restitution_gamma', gamma)

    def finish(self):
        self.emulator.assert_alive()
        last = self.status.messages[-1]
        self.assertEqual((last.budget_exhausted, last.search_failures, last.dropped_messages), (0, 0, 0))
        self.assertEqual(self.emulator.stop(), 0)
        bag, = (self.directory / 'bags').iterdir()
        assert_identical(self, str(bag))
        return bags.read(str(bag))

    def test_takes_a_level_for_whatever_is_in_force(self):
        self.play()
        self.for_every_drag_velocity()
        self.for_live_parameters_and_after_a_reset()
        self.many_changes_in_a_pause()
        configuration = self.finish()['configuration'][0]
        self.assertEqual((configuration.model, configuration.tolerance, configuration.tolerance_of),
                         ('auto', 0.02, 'friction'))

    def for_every_drag_velocity(self):
        first = self.applied.wait_for()
        self.assert_same(reported(first), HAMMER)
        self.assert_same(reported(self.status.wait_for_next(lambda m: m.time.tau > 0)), HAMMER)
        # it begins with the speed for eta = 3.4, and gets its holder's
        self.assertAlmostEqual(first.energy_dropped / ENERGY_UNIT, 0.5 * (3.4 ** 2 - 2 ** 2), places=9)
        for eta, level in ((3, BURSTS), (4, EVERY), (2, HAMMER), (-2, HAMMER), (2.5, BURSTS), (3.5, EVERY),
                           (1.5, UNKNOWN), (0, UNKNOWN), (2, HAMMER)):
            before = self.applied.messages[-1]
            message = self.drag(eta)
            self.assert_same(reported(message), level)
            self.assertEqual(message.energy_dropped != 0.0, level == HAMMER and before.model != 'hammer')
            self.assert_same(reported(self.status.wait_for_next(lambda m: key(m.time) > key(message.time))), level)

    def for_live_parameters_and_after_a_reset(self):
        self.assert_same(reported(self.set_gamma(0.75)), UNKNOWN)  # the table was measured with another
        self.assert_same(reported(self.set_gamma(0.7)), HAMMER)
        self.assert_same(reported(self.set_gamma(0.9)), UNKNOWN)
        self.assertTrue(self.emulator.call('reset', Trigger).success)
        self.assert_same(reported(self.applied.wait_for(lambda m: m.epoch == 1)), HAMMER)  # of the start
        # the table was measured without a bath
        self.assert_same(reported(self.set_parameter('quality_factor', 100.0)), UNKNOWN)
        self.assert_same(reported(self.set_parameter('quality_factor', 0.0)), HAMMER)

    def many_changes_in_a_pause(self):
        """They happen at one model time."""
        self.status.wait_for_next(lambda m: m.time.tau > 1000)
        for eta in (3, 2, 4, 2, 3):
            self.drag(eta)
            self.assertTrue(self.emulator.call('pause', SetBool, data=True).success)
            for again in (2, 4, eta, 2):
                self.drag(again)
            self.assertTrue(self.emulator.call('pause', SetBool, data=False).success)
        begin = self.status.messages[-1].time.tau
        self.status.wait_for(lambda m: m.time.tau > begin + 1000)

    def test_other_models_tell_their_level(self):
        self.parameters.update(model='hammer', tolerance=0.0, level_table='')
        self.play()
        self.assert_same(reported(self.applied.wait_for()), ('hammer', 0.002, math.nan))
        self.assert_same(reported(self.drag(4)), ('hammer', 0.002, math.nan))
        self.assert_same(reported(self.status.wait_for_next()), ('hammer', 0.002, math.nan))
        self.finish()

    def refusal(self, **parameters):
        emulator = self.start(Emulator(dict(self.parameters, **parameters)))
        self.assertEqual(emulator.wait(), 1)
        return emulator.output()

    def test_bad_input_is_refused_with_its_name_value_and_reason(self):
        for tolerance in (0.0, -0.1, math.inf, math.nan):
            self.assertRegex(self.refusal(tolerance=tolerance),
                             r'tolerance = -?(0|0.1\d*|inf|nan): must be above 0 and finite')
        self.assertIn('tolerance_of = "speed": there is no such quantity', self.refusal(tolerance_of='speed'))
        self.assertIn('level_table = "": model auto takes its levels from this file', self.refusal(level_table=''))
        self.assertIn('level_table = "/no/such/file": cannot be read: No such file',
                      self.refusal(level_table='/no/such/file'))
        self.table.write_text(HEAD + '1,2\n')
        self.assertRegex(self.refusal(), r'level_table = ".*levels.csv": line 3: \'1,2\' is not eta,model')
        self.assertIn('use oscillator, hammer or auto', self.refusal(model='pendulum'))


if __name__ == '__main__':
    run(Levels)

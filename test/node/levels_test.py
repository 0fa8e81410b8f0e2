"""model: auto takes for every drag velocity the cheapest level that its tolerance allows, and says which."""
import math
import tempfile

from emulator_under_test import ENERGY_UNIT, SPEED_UNIT, EmulatorTest
from topics import key

HEAD = ('# parameters: gamma 0.7 cutoff %.12g frequency_ratio 6.25 amplitude 0.09615384615384616 rest_height 0\n'
        'eta,model,contact_tolerance,k_f_error,deflection_error,cost\n' % (1.66e-7 / SPEED_UNIT))
# at eta = 2 the hammer will do, at 3 bursts, at 4 every bounce; between them the finer
TABLE = tempfile.NamedTemporaryFile('w')
TABLE.write(HEAD + ''.join('{0},hammer,0.001,{1},0,1\n{0},oscillator,0.001,{2},0,2\n{0},oscillator,0,0,0,4\n'.format(*r)
                           for r in ((2, 0.01, 0.0), (3, 0.3, 0.015), (4, 0.4, 0.1))))
TABLE.flush()
HAMMER, BURSTS, EVERY = ('hammer', 0.001, 0.01), ('oscillator', 0.001, 0.015), ('oscillator', 0.0, 0.0)
UNKNOWN = ('oscillator', 0.002, math.nan)


class Levels(EmulatorTest):
    parameters = {'model': 'auto', 'tolerance': 0.02, 'level_table': TABLE.name, 'contact_tolerance': 0.002,
                  'drag_velocity': 2 * SPEED_UNIT, 'sample_rate_hz': 50000.0}

    def tearDown(self):
        super().tearDown()
        last = self.topics['status'].messages[-1]
        self.assertEqual((last.budget_exhausted, last.search_failures), (0, 0))

    def assert_level(self, message, level):
        self.assertEqual(repr((message.model, message.contact_tolerance, message.expected_error)), repr(level))  # nan

    def test_for_every_drag_velocity(self):
        first = self.topics['applied'].wait_for()
        self.assert_level(first, HAMMER)
        self.assert_level(self.topics['status'].wait_for_next(lambda m: m.time.tau > 0), HAMMER)
        # it begins with the speed for eta = 3.4, and gets its holder's
        self.assertAlmostEqual(first.energy_dropped / ENERGY_UNIT, 0.5 * (3.4 ** 2 - 2 ** 2), places=9)
        for eta, level in ((3, BURSTS), (4, EVERY), (2, HAMMER), (-2, HAMMER), (2.5, BURSTS), (3.5, EVERY),
                           (1.5, UNKNOWN), (0, UNKNOWN), (2, HAMMER)):
            before = self.topics['applied'].messages[-1]
            message = self.drag(eta)
            self.assert_level(message, level)
            self.assertEqual(message.energy_dropped != 0.0, level == HAMMER and before.model != 'hammer')
            self.assert_level(self.topics['status'].wait_for_next(lambda m: key(m.time) > key(message.time)), level)
        configuration = self.topics['configuration'].messages[-1]
        self.assertEqual((configuration.model, configuration.tolerance, configuration.tolerance_of),
                         ('auto', 0.02, 'friction'))

    def test_for_live_parameters_and_after_a_reset(self):
        # the table was measured with this restitution, and without a bath
        for name, value, level in (('restitution_gamma', 0.75, UNKNOWN), ('restitution_gamma', 0.7, HAMMER),
                                   ('quality_factor', 100.0, UNKNOWN), ('quality_factor', 0.0, HAMMER),
                                   ('restitution_gamma', 0.9, UNKNOWN)):
            count = len(self.topics['applied'].messages)
            self.emulator.set(**{name: value})
            self.assert_level(self.topics['applied'].wait_for(lambda m: getattr(m, name) == value, begin=count), level)
        self.begin()
        self.assert_level(self.topics['applied'].messages[0], HAMMER)  # of the start

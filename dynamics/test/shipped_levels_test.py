"""The errors in config/levels.csv are those of the code as it is. usage: shipped_levels_test.py LEVEL_TABLE
LEVELS.CSV"""
import csv
import subprocess
import sys
import unittest

TOOL, SHIPPED = sys.argv.pop(1), sys.argv.pop(1)
ETAS = '0.7,1,2.1,3,5.3'  # chatter, glide, coexisting attractors, splash, chaos


def errors_of(lines):
    """{level at a drag speed: what the table says of it, but for the cost, which is of the machine}"""
    errors = {}
    for row in csv.DictReader(line for line in lines if not line.startswith('#')):  # where the table comes from
        del row['cost']
        errors[row['eta'], row['model'], row['contact_tolerance']] = row
    return errors


def is_fine(level):
    """Coarser levels are left out where they cost more than what they approximate."""
    _, model, tolerance = level
    return model == 'oscillator' and float(tolerance) <= 1e-3


class ShippedLevels(unittest.TestCase):
    def test_errors_measured_again_are_the_same(self):
        measured = errors_of(subprocess.check_output([TOOL, '--eta', ETAS], universal_newlines=True).splitlines())
        with open(SHIPPED) as file:
            shipped = errors_of(file)
        speeds = {eta for eta, _, _ in measured}
        self.assertEqual(len(speeds), len(ETAS.split(',')))
        self.assertEqual({level for level in measured if is_fine(level)},
                         {level for level in shipped if is_fine(level) and level[0] in speeds})
        for level in measured.keys() & shipped.keys():
            with self.subTest(level=level):
                self.assertEqual(measured[level], shipped[level])


if __name__ == '__main__':
    unittest.main()

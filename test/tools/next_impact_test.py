#!/usr/bin/env python3
"""The tool next_impact as a filter: against the reference flights, and on input of every bad kind.

Usage: next_impact_test.py TOOL DATA_DIRECTORY
"""
import csv
import os
import subprocess
import sys
import tempfile
import unittest

from tables import run_tool

TOOL, DATA = None, None
INPUTS = ['eta', 'gamma', 'cutoff', 'phase', 'extension', 'u', 'w']
OUTPUTS = ['dt', 'phase_next', 'extension_next', 'u_next', 'w_next', 'normal_speed', 'tangential_velocity',
           'energy_loss']
HEADER = ','.join(INPUTS)
GOOD_ROW = '3.4,0.7,0.05,0.25,0,3.4,2'


def run(text, *arguments):
    """Exit code, rows as dictionaries, lines of complaint."""
    code, rows, complaints = run_tool(TOOL, *arguments, text=text)
    return code, rows, complaints.splitlines()


def table(*rows):
    return '\n'.join([HEADER, *rows]) + '\n'


class Reference(unittest.TestCase):
    def test_flights(self):
        """A row for each. reference_flights_test.cpp tests the library to the bounds of rounding."""
        for name in ('next_impact.csv', 'next_impact_grazing.csv'):
            with open(os.path.join(DATA, name)) as file:
                truth = list(csv.DictReader(file))
            code, rows, complaints = run(table(*(','.join(row[key] for key in INPUTS) for row in truth)))
            self.assertEqual((code, complaints, len(rows)), (0, [], len(truth)))
            for row, exact in zip(rows, truth):
                self.assertEqual(list(row), INPUTS + OUTPUTS)
                for key in INPUTS:
                    self.assertEqual(float(row[key]), float(exact[key]))
                for key in OUTPUTS:
                    self.assertAlmostEqual(float(row[key]), float(exact[key]), delta=1e-6, msg=key)


class BadInput(unittest.TestCase):
    def assert_refused(self, row, *reasons):
        code, rows, complaints = run(table(GOOD_ROW, row, GOOD_ROW))
        self.assertEqual(code, 1, row)
        self.assertEqual(len(complaints), 1, complaints)
        self.assertIn('stdin:3:', complaints[0])
        for reason in reasons:
            self.assertIn(reason, complaints[0])
        self.assertEqual([rows[1][key] for key in OUTPUTS], ['nan'] * 8)
        for good in (rows[0], rows[2]):
            self.assertGreater(float(good['dt']), 0.0)

    def test_rows_that_are_no_rows(self):
        self.assert_refused('1,2,3', 'expected 7 fields', 'found 3')
        self.assert_refused(GOOD_ROW + ',9', 'expected 7 fields', 'found 8')
        self.assert_refused('3.4,0.7,,0.25,0,3.4,2', "cutoff = ''", 'not a number')
        self.assert_refused('3.4,0.7x,0.05,0.25,zero,3.4,2', "gamma = '0.7x'", "extension = 'zero'")

    def test_parameters_out_of_range_are_all_named(self):
        self.assert_refused('3.4,1.5,-1,0.25,0,3.4,2', 'gamma = 1.5', 'cutoff = -1')
        self.assert_refused('1e4,0.7,0.05,0.25,11,3.4,2e3', 'eta = 10000', 'extension = 11', 'w = 2000')
        self.assert_refused('nan,inf,nan,nan,nan,nan,nan', 'eta', 'gamma', 'cutoff', 'phase', 'extension', 'u =', 'w =')

    def test_states_that_do_not_leave_the_surface(self):
        self.assert_refused('3.4,0.7,0.05,0.25,0,-3.4,-3', 'does not leave the surface')
        self.assert_refused('3.4,0.7,0.05,0,0,3.4,0', 'does not leave the surface')

    def test_a_flight_without_end(self):
        # in a valley that it hardly leaves
        self.assert_refused('1e-5,0.7,0.05,0.4,-0.08,1e-5,1e-6', 'no impact within 1000 tau')

    def test_a_table_without_a_header(self):
        for text in ('', '\n\n', GOOD_ROW + '\n', 'eta,gamma\n' + GOOD_ROW + '\n'):
            code, rows, complaints = run(text)
            self.assertEqual((code, len(rows)), (1, 0))
            self.assertIn("expected '" + HEADER + "'", complaints[0])

    def test_a_file_that_is_not_there(self):
        code, rows, complaints = run('', 'no/such/table.csv')
        self.assertEqual((code, len(rows)), (1, 0))
        self.assertIn("'no/such/table.csv'", complaints[0])

    def test_a_full_disk(self):
        with open('/dev/full', 'w') as full:
            done = subprocess.run([TOOL], input=table(GOOD_ROW).encode(), stdout=full, stderr=subprocess.PIPE,
                                  timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b'cannot write', done.stderr)


class Forms(unittest.TestCase):
    def test_line_ends_blank_lines_spaces_and_byte_order_mark(self):
        plain = run(table(GOOD_ROW, GOOD_ROW))
        spaced = GOOD_ROW.replace(',', ' , ')
        self.assertEqual(plain[0], 0)
        self.assertEqual(run('\ufeff' + HEADER + '\r\n\r\n' + GOOD_ROW + '\r\n  \r\n' + spaced), plain)

    def test_files_and_standard_input_in_turn(self):
        reference = os.path.join(DATA, 'next_impact.csv')  # with columns too many: no table of inputs
        code, rows, complaints = run(table(GOOD_ROW), '-', reference)
        self.assertEqual((code, len(rows)), (1, 1))
        self.assertIn(reference + ':1:', complaints[0])

    def test_files_one_after_the_other(self):
        with tempfile.NamedTemporaryFile('w', suffix='.csv') as file:
            file.write(table(GOOD_ROW))
            file.flush()
            once = run(table(GOOD_ROW))
            twice = run('', file.name, file.name)
        self.assertEqual(twice, (0, once[1] * 2, []))

    def test_an_empty_table_is_a_table(self):
        self.assertEqual(run(HEADER + '\n'), (0, [], []))


if __name__ == '__main__':
    TOOL, DATA = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])

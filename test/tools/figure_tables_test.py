"""A table of scripts/figures is that of the command which asks for it. usage: figure_tables_test.py SCRIPTS"""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, sys.argv.pop(1))
from plotting.tools import Tables  # noqa: E402


class Counted(Tables):
    """The one row of a table: how long its command was to run, and the how many-th run it was."""
    runs = 0

    def run(self, file, tool, option, duration):
        self.runs += 1
        file.write('duration,run\n%g,%d\n' % (duration, self.runs))


class FigureTables(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def make(self, tables, duration):
        row, = tables.make('windows', 'friction_windows', '--duration', duration)
        self.assertEqual(row['duration'], duration)
        return row['run']

    def test_two_figures_share_one_run(self):
        tables = Counted(self.directory, keep=False, quick=False)
        self.assertEqual([self.make(tables, 50), self.make(tables, 50)], [1, 1])

    def test_another_command_of_the_same_name_is_run(self):
        tables = Counted(self.directory, keep=False, quick=False)
        self.assertEqual([self.make(tables, 50), self.make(tables, 200)], [1, 2])

    def test_what_is_kept_is_of_the_same_command(self):
        self.make(Counted(self.directory, keep=False, quick=False), 5)
        kept = Counted(self.directory, keep=True, quick=False)
        self.make(kept, 5)
        self.assertEqual(kept.runs, 0)
        self.make(kept, 50)
        self.assertEqual(kept.runs, 1)

    def test_without_keep_everything_is_made_anew(self):
        self.make(Counted(self.directory, keep=False, quick=False), 5)
        again = Counted(self.directory, keep=False, quick=False)
        self.make(again, 5)
        self.assertEqual(again.runs, 1)


if __name__ == '__main__':
    unittest.main()

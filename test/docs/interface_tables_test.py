#!/usr/bin/python3
"""The tables of docs/interface.md are whole, and the names of parameters keep the rule. usage: interface_tables_test.py
ROOT"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / 'workflow'))
import interface as tables  # noqa: E402

TEXT = (ROOT / 'docs/interface.md').read_text()

# the end of a name and the unit it stands for; the first that fits counts
ENDS = (('resonance_hz', 'Hz'), ('_rad_per_s', 'rad/s'), ('_n_per_m', 'N/m'), ('_per_tau', '1/tau'), ('_tau', 'tau'),
        ('_kg', 'kg'), ('_hz', '1/s'), ('_mb', 'MB'), ('_k', 'K'), ('_m', 'm'), ('_s', 's'), ('_n', 'N'))
NATURAL = ('a', 'a/tau', 'a, a/tau')


def is_number(text):
    return re.fullmatch(r'-?[\d.]+(e[-+]?\d+)?', text) is not None


def units_by_name(name):
    """All units that the rule allows for a number of this name."""
    for end, unit in ENDS:
        if name.endswith(end):
            return (unit,)
    if name.endswith(('velocity', 'speed')):
        return ('m/s',)
    return NATURAL if name.startswith('initial_') or name == 'contact_tolerance' else ('-',)


class InterfaceTables(unittest.TestCase):
    def test_nothing_is_missing(self):
        shown = set(re.findall(r'<!-- interface: (\w+) ?(\w*) -->', TEXT))
        files = {('message', path.stem) for path in (ROOT / 'msg').glob('*.msg')}
        files |= {('service', path.stem) for path in (ROOT / 'srv').glob('*.srv')}
        files |= {('launch', path.stem) for path in (ROOT / 'launch').glob('*.launch')}
        self.assertEqual(shown, files | {('parameters', '')})

    def test_every_line_of_the_parameters_is_read(self):
        written = re.findall(r'^(\w+):', (ROOT / 'config/emulator.yaml').read_text(), re.M)
        self.assertEqual([row[0] for row in tables.parameters()], written)
        self.assertGreater(len(written), 30)

    def test_every_live_parameter_has_its_row(self):
        rows = re.search(r'\n## Live parameters\n.*?\n((?:\|[^\n]*\n)+)', TEXT, re.S)[1]
        live = re.search(r'LIVE = \((.*?)\)', (ROOT / 'config/Emulator.cfg').read_text(), re.S)[1]
        sliders = re.findall(r"'(\w+)'", live)
        self.assertGreater(len(sliders), 8)
        shown = re.findall(r'`(\w+)`', ' '.join(row.split('|')[1] for row in rows.splitlines()))
        self.assertEqual(set(shown), set(sliders))

    def test_names_end_in_their_units(self):
        for name, value, unit, _ in tables.parameters():
            with self.subTest(name=name):
                self.assertIn(unit, units_by_name(name) if is_number(value) else ('',))

    def test_every_argument_of_a_launch_file_is_explained(self):
        for path in (ROOT / 'launch').glob('*.launch'):
            for row in tables.render_launch(path.stem).splitlines()[2:]:
                self.assertFalse(row.endswith('|  |'), '%s: %s' % (path.name, row))


if __name__ == '__main__':
    unittest.main()

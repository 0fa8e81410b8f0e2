#!/usr/bin/python3
"""What the constants of the impact search cost: evaluations of the gap per impact, with each of them changed alone. No
constant decides an impact, as every step is certified. Prints the table of docs/algorithm.md.

usage: search_constants.py"""
import argparse
import csv
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CONSTANTS = [('kRootReach', 'impact_steps.h', [1.05, 1.1, 1.25, 1.5, 2.0]),
             ('kRoundingReach', 'impact_steps.h', [2.0, 4.0, 8.0]),
             ('kLookahead', 'impact_search.h', [0.5, 0.7, 0.8, 0.9, 1.0]),
             ('kDescent', 'impact_search.h', [0.3, 0.4, 0.46, 0.55, 0.7]),
             ('kFirstTrial', 'impact_search.h', [0.02, 0.05, 0.1]),
             ('kReturns', 'impact_search.h', [-1.2, -1.4, -1.6, -1.8, -2.0])]
SOURCES = ['benchmark/search_constants.cpp', 'src/core/search/landing.cpp', 'src/core/search/double_double.cpp',
           'src/core/search/finer_landing.cpp', 'src/core/state.cpp', 'src/core/model.cpp', 'src/core/number_text.cpp']


def measure(work, name, header, value):
    """Evaluations per impact, impacts, searches that stay undecided in double precision; and whether this is in use."""
    path = work / 'src/core/search' / header
    text = path.read_text()
    changed, count = re.subn(r'(constexpr double %s = )([-0-9.]+);' % name, r'\g<1>%r;' % value, text)
    if count != 1:
        sys.exit('search_constants: no constant %s in %s' % (name, header))
    path.write_text(changed)
    program = work / 'program'
    includes = ['-I', str(ROOT / 'include'), '-I', str(work / 'src')]
    subprocess.run(['c++', '-std=c++17', '-O2', '-ffp-contract=off'] + includes +
                   [str(work / source) for source in SOURCES] + ['-o', str(program)], check=True)
    row = subprocess.check_output([str(program)], universal_newlines=True).strip().split(',')
    path.write_text(text)
    return row + ['yes' if changed == text else '']


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['constant', 'value', 'evaluations', 'impacts', 'undecided', 'in use'])
    with tempfile.TemporaryDirectory() as work:
        for folder in ('src/core', 'benchmark'):
            shutil.copytree(str(ROOT / folder), str(Path(work) / folder))
        for name, header, values in CONSTANTS:
            for value in values:
                table.writerow([name, value] + measure(Path(work), name, header, value))
                sys.stdout.flush()


if __name__ == '__main__':
    main()

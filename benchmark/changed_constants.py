#!/usr/bin/python3
"""What the constants of the impact search and of chatter do, each of them changed alone: a table of docs/algorithm.md.

usage: changed_constants.py search     evaluations of the gap per impact; no constant decides an impact
       changed_constants.py chatter    error of a sequence in the state at the next impact, in 99 of 100"""
import argparse
import csv
import re
import shutil
import subprocess
import sys
import tempfile
from collections import namedtuple
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# the program, its arguments, the folder of the headers with constants, who includes them, (constant, header, values)
Study = namedtuple('Study', 'program arguments folder includers constants columns')

POINTS = ['eta %s, v_c %s' % (eta, cutoff) for cutoff in ('0.005', '0.05') for eta in ('0.5', '5')]
STUDIES = {
    'search': Study('search_constants', [], 'src/core/search', ['search_constants', 'landing', 'finer_landing'], [
        ('kRootReach', 'impact_steps.h', [1.05, 1.1, 1.25, 1.5, 2.0]),
        ('kRoundingReach', 'impact_steps.h', [2.0, 4.0, 8.0]),
        ('kLookahead', 'impact_search.h', [0.5, 0.7, 0.8, 0.9, 1.0]),
        ('kDescent', 'impact_search.h', [0.3, 0.4, 0.46, 0.55, 0.7]),
        ('kFirstTrial', 'impact_search.h', [0.02, 0.05, 0.1]),
        ('kReturns', 'impact_search.h', [-1.2, -1.4, -1.6, -1.8, -2.0])],
        ['evaluations', 'impacts', 'undecided']),
    'chatter': Study('burst_error', '--eta 0.5 5 --cutoff 0.005 0.05 --bursts 400 --most-bounces 5000'.split(),
                     'src/core/contact', ['chatter'], [
        ('kMaxLoss', 'chatter_law.h', [0.05, 0.1, 0.2]),
        ('kMaxRatioAtEntry', 'chatter_law.h', [0.03, 0.06, 0.08]),
        ('kMaxRatioWithin', 'chatter_law.h', [0.06, 0.08, 0.12]),
        ('kAccepted', 'chatter_law.h', [1.02, 1.05, 1.1]),
        ('kMaxFall', 'chatter_law.h', [1.0, 2.0, 4.0]),
        ('kStep', 'chatter_law.h', [0.25, 0.5, 1.0]),
        ('kMaxChange', 'chatter_law.h', [0.8, 1.6, 3.2]),
        ('kEndSpeed', 'chatter_law.h', [0.8, 0.9, 0.95]),
        ('kNearlyWhole', 'chatter_law.h', [5e-4, 1e-3, 2e-3])],
        POINTS)}


def compile_(work, source):
    """The object of a source of the copy in `work`."""
    target = source.with_suffix('.o')
    folders = [ROOT / 'include', work / 'src', work / 'benchmark']
    options = ['-std=c++17', '-O2', '-ffp-contract=off', '-DAFM_CONFIG=""'] + ['-I%s' % folder for folder in folders]
    subprocess.run(['c++'] + options + ['-c', str(source), '-o', str(target)], check=True)
    return target


def answer(work, study, objects):
    """What the program prints of each of its points: of the search one row of columns, of chatter a row for each."""
    program = work / study.program
    libraries = ['-lboost_program_options', '-lyaml-cpp']
    subprocess.run(['c++', '-pthread'] + [str(o) for o in objects] + libraries + ['-o', str(program)], check=True)
    rows = list(csv.reader(subprocess.check_output([str(program)] + study.arguments,
                                                   universal_newlines=True).splitlines()))
    return rows[0] if len(rows) == 1 else [row[rows[0].index('99_percent')] for row in rows[1:]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('study', choices=sorted(STUDIES))
    study = STUDIES[parser.parse_args().study]
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['constant', 'value'] + study.columns + ['in use'])
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for name in ('src/core', 'src/common', 'benchmark'):
            shutil.copytree(str(ROOT / name), str(work / name))
        sources = [work / 'benchmark' / (study.program + '.cpp')]
        sources += sorted((work / 'src/common').glob('*.cpp')) + sorted((work / 'src/core').glob('**/*.cpp'))
        objects = [compile_(work, source) for source in sources]
        includers = [source for source in sources if source.stem in study.includers]
        for constant, header, values in study.constants:
            path = work / study.folder / header
            text = path.read_text()
            found = re.search(r'constexpr double %s = ([-0-9.e]+);' % constant, text)
            if not found:
                sys.exit('changed_constants: no constant %s in %s' % (constant, header))
            in_use = float(found.group(1))
            for value in values:
                path.write_text(text[:found.start(1)] + repr(value) + text[found.end(1):])
                for source in includers:
                    compile_(work, source)
                table.writerow([constant, value] + answer(work, study, objects) + ['yes' if value == in_use else ''])
                sys.stdout.flush()
            path.write_text(text)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
"""How long things take on this machine, in processor seconds. What other programs do meanwhile changes them less than
the time on the clock. With --builds the builds too, each in a directory of its own, without ccache (minutes). Prints
the table of docs/durations.md.

usage: durations.py [--builds] [--only WORD]"""
import argparse
import csv
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PYTHON = 'python3 -c "import afm; %s"'
BUILD = 'AFM_BUILD_DIR=$SCRATCH/%s CCACHE_DISABLE=1 scripts/build%s'
# (what, its command)
SHORT = (
    ('`import afm`', PYTHON % 'pass'),
    ('one tip, 100,000 tau at eta = 3.4', PYTHON % 'tip = afm.Tip(eta=3.4); tip.advance(100000)'),
    ('the same at 300 K, 10,000 tau',
     PYTHON % 'bath = afm.Units().bath(temperature_k=300.0, quality_factor=100.0); afm.Tip(bath=bath).advance(10000)'),
    ('FIG. 1 in Python, 179 points', '(cd $SCRATCH && python3 %s/examples/python/friction_peaks.py)' % ROOT),
    ('`friction_curve`, 11 points from eta = 2 to 3', 'rosrun afm_emulator friction_curve --eta 2:3:0.1'),
    ('`attractors` of 10,000 starts at eta = 3.75', PYTHON % 'afm.attractors(3.75, starts=10000)'),
    ('`periodic_orbits` of up to 6 impacts at eta = 3.4', 'rosrun afm_emulator periodic_orbits --eta 3.4 --gamma 0.7'),
    ('`afm.lyapunov(3.4)`, 2000 tau', PYTHON % 'afm.lyapunov(3.4)'),
)
WITHOUT_ROS = ('rm -rf $SCRATCH/without_ros && cmake -S . -B $SCRATCH/without_ros -DAFM_ROS=OFF && '
               'CCACHE_DISABLE=1 cmake --build $SCRATCH/without_ros --parallel 2%s')
BUILDS = (
    ('the first `scripts/run`: the emulator', BUILD % ('emulator', ' --emulator')),
    ('`scripts/build`: everything', BUILD % ('all', '')),
    ('the Python module without ROS', WITHOUT_ROS % ' --target afm_python'),
    ('everything without ROS', WITHOUT_ROS % ''),
    ('`scripts/docs`: this site', 'scripts/docs --built $CMAKE_PREFIX_PATH --output $SCRATCH/docs'),
)


def processor_seconds(command, scratch):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = dict(os.environ, SCRATCH=scratch, CMAKE_PREFIX_PATH=os.environ['CMAKE_PREFIX_PATH'].split(':')[0])
    done = subprocess.run(['bash', '-c', command], cwd=str(ROOT), env=environment, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode != 0:
        sys.exit('%s ends with %d:\n%s' % (command, done.returncode, done.stderr))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--builds', action='store_true')
    parser.add_argument('--only', default='', help='rows whose name holds this word')
    arguments = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['what', 'processor seconds'])
    with tempfile.TemporaryDirectory() as scratch:
        for what, command in (BUILDS if arguments.builds else ()) + SHORT:
            if arguments.only in what:
                table.writerow([what, '%g' % float('%.2g' % processor_seconds(command, scratch))])
                sys.stdout.flush()


if __name__ == '__main__':
    main()

#!/usr/bin/python3
"""How long a controller waits for its command: starts a master and an emulator of its own, at batches of 100 Hz and of
1 kHz, and runs the example loop_delay beside it. Writes the table of docs/interface.md.

usage: loop_delay.py [--commands N] [--output FILE]     (default: 1000, docs/data/loop_delay.csv)"""
import argparse
import subprocess
from pathlib import Path

from emulator import DATA, PATIENCE_S, binary, emulator, own_master, write_table

RATES = (100.0, 1000.0)


def measure(server, rate, commands):
    """The lines that the example prints: a header and a row."""
    with emulator(server, {'batch_rate_hz': rate, 'drag_velocity': 6.62e-6}):
        done = subprocess.run([binary('loop_delay'), '_commands:=%d' % commands], check=True, stdout=subprocess.PIPE,
                              text=True, timeout=PATIENCE_S + commands)
        return [line for line in done.stdout.splitlines() if not line.startswith('[')]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--commands', type=int, default=1000)
    parser.add_argument('--output', type=Path, default=DATA / 'loop_delay.csv')
    arguments = parser.parse_args()
    with own_master() as server:
        tables = [measure(server, rate, arguments.commands) for rate in RATES]
    write_table(arguments.output, tables[0][:1] + [table[1] for table in tables])


if __name__ == '__main__':
    main()

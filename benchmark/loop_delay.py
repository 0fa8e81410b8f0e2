#!/usr/bin/python3
"""How long a controller waits for its command: starts a master and an emulator of its own, at batches of 100 Hz and of
1 kHz, and runs the example loop_delay beside it. Prints the table of docs/interface.md.

usage: loop_delay.py [--commands N]     (default: 1000)"""
import subprocess

from emulator import PATIENCE_S, binary, emulator, option, own_master

RATES = (100.0, 1000.0)


def measure(server, rate, commands):
    """The lines that the example prints: a header and a row."""
    with emulator(server, {'batch_rate_hz': rate, 'drag_velocity': 6.62e-6}):
        done = subprocess.run([binary('loop_delay'), '_commands:=%d' % commands], check=True, stdout=subprocess.PIPE,
                              text=True, timeout=PATIENCE_S + commands)
        return [line for line in done.stdout.splitlines() if not line.startswith('[')]


def main():
    commands = option(__doc__, 'commands', 1000)
    with own_master() as server:
        tables = [measure(server, rate, commands) for rate in RATES]
    print('\n'.join(tables[0][:1] + [table[1] for table in tables]))


if __name__ == '__main__':
    main()

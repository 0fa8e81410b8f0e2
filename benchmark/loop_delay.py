#!/usr/bin/python3
"""How long a controller waits for its command: starts a master and an emulator of its own, at batches of 100 Hz and of
1 kHz, and runs the example loop_delay beside it. Writes the table of docs/interface.md.

usage: loop_delay.py [--commands N] [--output FILE]     (default: 1000, docs/data/loop_delay.csv)"""
import argparse
import os
import signal
import subprocess
import time
import xmlrpc.client
from pathlib import Path

from record_throughput import free_port

RATES = (100.0, 1000.0)
PATIENCE_S = 30.0


def binary(name):
    return subprocess.check_output(['catkin_find', '--first-only', '--libexec', 'afm_emulator', name],
                                   text=True).strip()


def wait_for(server):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        try:
            return server.getPid('loop_delay')
        except OSError:
            time.sleep(0.1)
    raise SystemExit('the master does not answer')


def measure(server, rate, commands):
    """The lines that the example prints: a header and a row."""
    server.setParam('loop_delay', '/afm', {'batch_rate_hz': rate, 'drag_velocity': 6.62e-6})
    emulator = subprocess.Popen([binary('emulator_node'), '__name:=afm'])
    try:
        done = subprocess.run([binary('loop_delay'), '_commands:=%d' % commands], check=True, stdout=subprocess.PIPE,
                              text=True, timeout=PATIENCE_S + commands)
        return [line for line in done.stdout.splitlines() if not line.startswith('[')]
    finally:
        emulator.send_signal(signal.SIGINT)
        emulator.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--commands', type=int, default=1000)
    parser.add_argument('--output', type=Path,
                        default=Path(__file__).resolve().parent.parent / 'docs/data/loop_delay.csv')
    arguments = parser.parse_args()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % free_port()
    master = subprocess.Popen(['rosmaster', '--core', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]])
    try:
        server = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        wait_for(server)
        tables = [measure(server, rate, arguments.commands) for rate in RATES]
    finally:
        master.kill()
    lines = tables[0][:1] + [table[1] for table in tables]
    arguments.output.write_text('\n'.join(lines) + '\n')
    print('\n'.join(lines))


if __name__ == '__main__':
    main()

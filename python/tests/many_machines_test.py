#!/usr/bin/python3
"""A map by dask: the same bytes for any number of workers, whatever stops it, and the numbers of afm.friction_curve.

Usage: many_machines_test.py EXAMPLE
"""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

import afm

EXAMPLE = Path(sys.argv[1]).resolve()
DEADLINE = 120.0
DURATION = 200.0


class ManyMachines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def start(self, name, workers, points):
        command = [sys.executable, str(EXAMPLE), str(self.folder / name), '--workers', str(workers),
                   '--points', str(points), '--duration', str(DURATION)]
        return subprocess.Popen(command, cwd=str(self.folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                start_new_session=True)

    def table(self, name, workers, points):
        process = self.start(name, workers, points)
        output = process.communicate(timeout=DEADLINE)[0]
        self.assertEqual(process.returncode, 0, output)
        return (self.folder / name).read_bytes()

    def stop_at(self, rows, name, points):
        """Kills it with its workers when so many rows are there."""
        process, path, deadline = self.start(name, 1, points), self.folder / name, time.monotonic() + DEADLINE
        while not (path.exists() and path.read_bytes().count(b'\n') >= rows) and time.monotonic() < deadline:
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate(timeout=DEADLINE)
        self.assertGreaterEqual(path.read_bytes().count(b'\n'), rows)

    def test_the_same_bytes(self):
        points = 10
        one = self.table('one.csv', 1, points)
        self.stop_at(20, 'stopped.csv', points)
        stopped = self.folder / 'stopped.csv'
        lines = stopped.read_bytes().splitlines(True)
        self.assertLess(len(lines), 30 * points, 'it was not stopped')
        stopped.write_bytes(b''.join(lines[:-1]) + b'0.5,')  # a kill may cut a drag speed short, and a line
        self.assertEqual(self.table('stopped.csv', 2, points), one)
        gamma, eta, friction, _ = np.loadtxt(one.decode().splitlines(), delimiter=',')[-1]
        curve = afm.friction_curve(eta, gamma=gamma, duration=DURATION, transient=0.1 * DURATION)
        self.assertEqual(curve['k_f_work'][0], friction)
        other = self.start('one.csv', 1, points + 1)
        self.assertIn(b'holds something else', other.communicate(timeout=DEADLINE)[0])
        self.assertEqual((other.returncode, (self.folder / 'one.csv').read_bytes()), (2, one))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

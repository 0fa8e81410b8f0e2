#!/usr/bin/python3
"""A map of friction by many machines: its points are computed by the workers of a dask cluster.

Usage: many_machines.py TABLE [--scheduler HOST:PORT] [--workers N] [--points N] [--duration TAU]

Without a scheduler the workers run on this machine. Interrupted and started again, the same command goes on: the
table holds a row for each point in order, so its length tells how many are done. It does not go on with a table of
other points. A point depends on its arguments alone: the bytes of the table are the same for any number of workers.
"""
import argparse
import itertools
import logging
from pathlib import Path

import dask
import numpy as np
from distributed import Client, LocalCluster

import afm

POINTS_OF_A_TASK = 30  # dask takes some 10 ms of processor time for each task


def begin_of_row(gamma, eta, duration):
    return '%.17g,%.17g,%.17g,' % (gamma, eta, duration)


def row(gamma, eta, duration):
    point = afm.friction_curve(eta, gamma=gamma, duration=duration, transient=0.1 * duration, threads=1)[0]
    return begin_of_row(gamma, eta, duration) + '%.17g,%.17g\n' % (point['k_f_work'], point['k_f_work_std_error'])


def rows(points, duration):
    return ''.join(row(*point, duration) for point in points)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', type=Path)
    parser.add_argument('--scheduler', help='of a running cluster (dask-scheduler)')
    parser.add_argument('--workers', type=int, help='on this machine; one for each processor')
    parser.add_argument('--points', type=int, default=900, help='drag speeds, for each of ten restitutions')
    parser.add_argument('--duration', type=float, default=1000.0, help='of each measurement [tau]')
    options = parser.parse_args()
    points = list(itertools.product(np.linspace(0.5, 0.95, 10), np.linspace(0.05, 9.0, options.points)))
    whole = options.table.read_text().splitlines(True) if options.table.exists() else []
    done = [line for line in whole if line.endswith('\n')]  # a kill may have cut the last one
    if len(done) > len(points) or not all(line.startswith(begin_of_row(*point, options.duration))
                                          for line, point in zip(done, points)):
        parser.error('%s holds other points, or was measured for another duration' % options.table)
    options.table.write_text(''.join(done))
    todo = points[len(done):]
    dask.config.set({'distributed.worker.profile.enabled': False})  # it looks at the stack of a worker each 10 ms
    # silent: a heartbeat that is under way at the end is no error, and one of a task is raised by result()
    cluster = options.scheduler or LocalCluster(options.workers, threads_per_worker=1, dashboard_address=None,
                                                silence_logs=logging.CRITICAL)
    with Client(cluster) as client, options.table.open('a') as table:
        tasks = [todo[i:i + POINTS_OF_A_TASK] for i in range(0, len(todo), POINTS_OF_A_TASK)]
        for future in client.map(rows, tasks, duration=options.duration, pure=False):
            table.write(future.result())
            table.flush()


if __name__ == '__main__':
    main()

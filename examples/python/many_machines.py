#!/usr/bin/python3
"""A map of friction by many machines: its points are computed by the workers of a dask cluster.

Usage: many_machines.py TABLE [--scheduler HOST:PORT] [--workers N] [--points N] [--duration TAU]

Without a scheduler the workers run on this machine. Interrupted and started again, the same command goes on: the
table is in order, so its length tells what is done. It does not go on with a table of other points, which the first
line names. The bytes of the table are the same for any number of workers.
"""
import argparse
import logging
from pathlib import Path

import dask
import numpy as np
from distributed import Client, LocalCluster

import afm

GAMMAS = np.linspace(0.5, 0.95, 30)  # a task is all of them, as dask takes some 10 ms of processor time for each


def rows(eta, duration):
    text = ''
    for gamma in GAMMAS:
        point, = afm.friction_curve(eta, gamma=gamma, duration=duration, transient=0.1 * duration, threads=1)
        text += '%.17g,%.17g,%.17g,%.17g\n' % (gamma, eta, point['k_f_work'], point['k_f_work_std_error'])
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', type=Path)
    parser.add_argument('--scheduler', help='of a running cluster (dask-scheduler)')
    parser.add_argument('--workers', type=int, help='on this machine; one for each processor')
    parser.add_argument('--points', type=int, default=300, help='drag speeds, for each of thirty restitutions')
    parser.add_argument('--duration', type=float, default=1000.0, help='of each measurement [tau]')
    options = parser.parse_args()
    first = '# gamma,eta,k_f_work,k_f_work_std_error: %d drag speeds, %.17g tau each, afm %s\n' % (
        options.points, options.duration, afm.__version__)
    lines = options.table.read_text().splitlines(True) if options.table.exists() else []
    whole = [line for line in lines if line.endswith('\n')]  # a kill may have cut the last one
    if lines and lines[0] != first:
        parser.error('%s holds something else, or other points, another duration or version' % options.table)
    done = len(whole[1:]) // len(GAMMAS)
    options.table.write_text(''.join([first] + whole[1:1 + done * len(GAMMAS)]))
    dask.config.set({'distributed.worker.profile.enabled': False})  # it looks at the stack of a worker each 10 ms
    # silent: a heartbeat that is under way at the end is no error, and one of a task is raised by result()
    cluster = options.scheduler or LocalCluster(options.workers, threads_per_worker=1, dashboard_address=None,
                                                silence_logs=logging.CRITICAL)
    with Client(cluster) as client, options.table.open('a') as table:
        etas = np.linspace(0.05, 9.0, options.points)[done:]
        for future in client.map(rows, etas, duration=options.duration, pure=False):
            table.write(future.result())
            table.flush()


if __name__ == '__main__':
    main()

#!/usr/bin/python3
"""K_f by the work of the drag over successive windows of time, for tips from many random starts: whether they end
alike, and how long each stays where it is. Natural units. Prints a table.
"""
import argparse

import afm
import numpy as np


def windows(start, arguments):
    """(end of a window [tau], K_f in it) of one tip."""
    phase, height, speed = np.random.default_rng(start).random(3)
    bath = afm.Bath(arguments.temperature, arguments.quality_factor, stream=start)
    run = afm.Run(eta=arguments.eta, phase=phase, y=0.1 + 0.5 * height, u=speed * arguments.eta, bath=bath)
    ends = arguments.transient + arguments.window * np.arange(int(arguments.duration / arguments.window) + 1)
    since_start = [end * run.advance(end).friction['k_f_work'] for end in ends]
    return zip(ends[1:], np.diff(since_start) / arguments.window)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--eta', type=float, default=3.75, help='drag velocity [a/tau]')
    parser.add_argument('--temperature', type=float, default=0.0, help='kT of the heat bath [m_tip a^2/tau^2]')
    parser.add_argument('--quality-factor', type=float, default=0.0, help='of the cantilever; 0: no bath')
    parser.add_argument('--window', type=float, default=20.0, help='[tau]')
    parser.add_argument('--duration', type=float, default=2000.0, help='of each tip [tau]')
    parser.add_argument('--transient', type=float, default=1000.0, help='before it [tau]')
    parser.add_argument('--starts', type=int, default=24, help='tips')
    arguments = parser.parse_args()
    print('start,time,k_f_work')
    for start in range(arguments.starts):
        for end, k_f in windows(start, arguments):
            print('%d,%g,%.8g' % (start, end, k_f))


if __name__ == '__main__':
    main()

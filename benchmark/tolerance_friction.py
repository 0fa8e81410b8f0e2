#!/usr/bin/python3
"""K_f at the default contact tolerance, at which the bounces of a chatter sequence are one event, and at a finer one.
Natural units. Prints a table.

bursts: against every bounce by itself, where that can be done (docs/stability.md). What is left of the difference
should be 1e-3 of K_f, or chance: a few standard errors of the two.
collapse: a heated tip under load, by both estimators, in pairs of runs with the same kicks; at the finer tolerance
nearly all bounces are made (docs/levers.md).
"""
import argparse
import itertools
import math
import statistics

import afm

FINER, SEEDS = 1e-9, 8  # of `collapse`: contact tolerance of the reference, pairs of runs
AT_A_TIME = 100000  # events that are held in memory
KELVIN_300, QUALITY = 0.926, 100.0  # kT of mica's tip [m_tip a^2/tau^2]


def measure(model, eta, tolerance, bath, transient, tau, most_events=math.inf):
    """The estimate over so many tau, None where that takes more events; and how many events there were."""
    # the estimate begins anew when the drag velocity changes
    run = afm.Run(model, eta * (1.0 + 1e-9), y=0.2, u=eta, bath=bath, friction_window=1000.0,
                  **({} if tolerance is None else {'contact_tolerance': tolerance}))
    for end in (transient, transient + tau):
        while run.now < (end, 0.0):
            batch = run.advance(end, impacts=AT_A_TIME)
            if run.impacts > most_events:
                return None, run.impacts
        run.apply(eta=eta)
    return batch.friction, run.impacts


def bursts(arguments):
    print('eta,v_c,k_f,std_error,events,k_f_bounces,std_error_bounces,events_bounces,relative,in_std_errors')
    for eta, cutoff in itertools.product(arguments.eta or (0.2, 0.5, 1.5, 2.75, 3.0, 3.4, 5.0, 6.25, 7.0),
                                         (0.1, 0.03)):
        (a, events), (b, bounces) = (measure(afm.Model(cutoff=cutoff), eta, tolerance, afm.Bath(), 500, arguments.tau,
                                             arguments.most_events) for tolerance in (None, 0.0))
        rest = ',,,,'
        if b is not None:
            off, error = a['k_f'] - b['k_f'], math.hypot(a['k_f_std_error'], b['k_f_std_error'])
            rest = '%.9g,%.1e,%.3g,%.1e,%.2g' % (b['k_f'], b['k_f_std_error'], bounces, off / b['k_f'], off / error)
        print('%g,%g,%.9g,%.1e,%.3g,%s' % (eta, cutoff, a['k_f'], a['k_f_std_error'], events, rest), flush=True)


def mean(values):
    """And its standard error."""
    return sum(values) / len(values), statistics.stdev(values) / math.sqrt(len(values))


def collapse(arguments):
    print('omega_h/omega_v,rest height,eta,K_f by work,its std. error,bias by work,its error,'
          'K_f by impacts,the std. error,bias by impacts,the error')
    for ratio, height, eta in itertools.product((6.25, 21.0), (-0.3, -1.0, -3.0, -10.0),
                                                arguments.eta or (0.3, 1.5, 3.0)):
        model = afm.Model(cutoff=0.05, rest_height=height, frequency_ratio=ratio)
        pairs = [[measure(model, eta, tolerance, afm.Bath(KELVIN_300, QUALITY, seed=seed), 100,
                          arguments.tau // SEEDS)[0] for tolerance in (None, FINER)] for seed in range(1, SEEDS + 1)]
        results = [result for name in ('k_f_work', 'k_f')
                   for result in mean([a[name] for a, _ in pairs]) + mean([a[name] - b[name] for a, b in pairs])]
        print('%g,%g,%g,%.4g,%.2g,%.2g,%.2g,%.4g,%.2g,%.2g,%.2g' % (ratio, height, eta, *results), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', choices=('bursts', 'collapse'))
    parser.add_argument('--eta', type=float, nargs='+', help='drag velocities [a/tau]')
    parser.add_argument('--tau', type=int, default=10000, help='measured time of each')
    parser.add_argument('--most-events', type=float, default=2e7, help='a run of more is stopped')
    arguments = parser.parse_args()
    (bursts if arguments.table == 'bursts' else collapse)(arguments)


if __name__ == '__main__':
    main()

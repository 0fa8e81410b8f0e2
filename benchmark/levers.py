#!/usr/bin/python3
"""How many times real time one tip makes with the levers and on the crystals of config/, over loads and speeds: without
a bath, and with one at 300 K and Q = 100. In processor time, and in the lever's own tau. Prints a table.
"""
import argparse
import itertools
import time
from pathlib import Path

import afm
import yaml

CONFIG = Path(__file__).resolve().parents[1] / 'config'
LEVERS = ('paper', 'ppp_cont', 'csc37_b', 'soft', 'force_modulation', 'laterally_soft')
CRYSTALS = ('mica', 'nacl', 'hopg')
LOADS, SPEEDS = (0.0, 0.1, 0.4, 1.0, 10.0, 100.0), (0.01, 0.1, 1.0, 5.0, 20.0)  # [nN], [um/s]
HEAT = {'quality_factor': 100.0, 'kicks_per_tau': 11.09}  # of the paper's lever, whose file has none
RESULTS = ('times_real_time', 'impacts_per_tau', 'search_failures')


def run(units, eta, bath, options):
    """From the flank of the surface, or from a valley if the load holds the tip down there."""
    model = units.model
    start = dict(phase=0.5, y=-model.amplitude, u=0.0) if model.rest_height < -model.amplitude else {}
    tip = afm.Tip(model, eta, bath=bath, **start)
    begin = time.thread_time()
    tip.advance(options.transient)
    events = tip.advance(options.transient + options.tau)
    seconds = (time.thread_time() - begin) / (options.transient + options.tau)
    bounces = events['count'][events['kind'] <= afm.Kind.BURST].sum()
    return units.time / seconds, bounces / options.tau, tip.search_failures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tau', type=int, default=300, help='measured time each')
    parser.add_argument('--transient', type=int, default=100, help='time before that')
    options = parser.parse_args()
    print('lever,crystal,load_nn,speed_um_per_s,tau_us,frequency_ratio,amplitude,rest_height,eta,cutoff,temperature',
          *RESULTS, *('heated_' + name for name in RESULTS), sep=',')
    for lever, crystal, load, speed in itertools.product(LEVERS, CRYSTALS, LOADS, SPEEDS):
        spring, surface = (yaml.safe_load((CONFIG / path).read_text())
                           for path in ('levers/%s.yaml' % lever, 'surfaces/%s.yaml' % crystal))
        heat = {name: spring.pop(name, value) for name, value in HEAT.items()}
        units = afm.Units(load_n=1e-9 * load, **spring, **surface)
        model, eta, bath = units.model, 1e-6 * speed / units.velocity, units.bath(temperature_k=300.0, **heat)
        numbers = (load, speed, 1e6 * units.time, model.frequency_ratio, model.amplitude, model.rest_height, eta,
                   model.cutoff, bath.temperature, *run(units, eta, afm.Bath(), options), *run(units, eta, bath, options))
        print(lever, crystal, *('%.6g' % number for number in numbers), sep=',', flush=True)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
"""How many times real time one tip makes with the levers and on the crystals of config/, over loads and speeds: without
a bath, and with one at 300 K and Q = 100. In processor time, and in the lever's own tau. Prints a table.
"""
import argparse
import csv
import itertools
import subprocess
from pathlib import Path

import afm
import yaml

CONFIG = Path(__file__).resolve().parents[1] / 'config'
LEVERS = ('paper', 'ppp_cont', 'csc37_b', 'soft', 'force_modulation', 'laterally_soft')
CRYSTALS = ('mica', 'nacl', 'hopg')
LOADS, SPEEDS = (0.0, 0.1, 0.4, 1.0, 10.0, 100.0), (0.01, 0.1, 1.0, 5.0, 20.0)  # [nN], [um/s]
HEAT = {'quality_factor': 100.0, 'kicks_per_tau': 11.09}  # of the paper's lever, whose file has none
RESULTS = ('times_real_time', 'impacts_per_tau', 'search_failures')


def run(units, etas, bath, options):
    """A row for each drag speed, of the program real_time, which counts all in the tau of the paper."""
    model = units.model
    settings = {'eta': ','.join(map(repr, etas)), 'cutoff': model.cutoff, 'frequency-ratio': model.frequency_ratio,
                'amplitude': model.amplitude, 'rest-height': model.rest_height, 'temperature': bath.temperature,
                'quality-factor': bath.quality_factor, 'kicks-per-tau': bath.kicks_per_tau, **vars(options)}
    done = subprocess.run(['real_time', *('--%s=%s' % setting for setting in settings.items())], check=True,
                          stdout=subprocess.PIPE, universal_newlines=True)
    for row in csv.DictReader(done.stdout.splitlines()):
        row['times_real_time'] = '%.4g' % (float(row['times_real_time']) * units.time / afm.Units().time)
        yield [row[name] for name in RESULTS]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tau', type=int, default=300, help='measured time each')
    parser.add_argument('--transient', type=int, default=100, help='time before that')
    options = parser.parse_args()
    print('lever,crystal,load_nn,speed_um_per_s,tau_us,frequency_ratio,amplitude,rest_height,eta,cutoff,temperature',
          *RESULTS, *('heated_' + name for name in RESULTS), sep=',')
    for lever, crystal, load in itertools.product(LEVERS, CRYSTALS, LOADS):
        spring, surface = (yaml.safe_load((CONFIG / path).read_text())
                           for path in ('levers/%s.yaml' % lever, 'surfaces/%s.yaml' % crystal))
        heat = {name: spring.pop(name, value) for name, value in HEAT.items()}
        units = afm.Units(load_n=1e-9 * load, **spring, **surface)
        model, bath = units.model, units.bath(temperature_k=300.0, **heat)
        etas = [1e-6 * speed / units.velocity for speed in SPEEDS]
        for speed, eta, cold, heated in zip(SPEEDS, etas, run(units, etas, afm.Bath(), options),
                                            run(units, etas, bath, options)):
            numbers = (load, speed, 1e6 * units.time, model.frequency_ratio, model.amplitude, model.rest_height, eta,
                       model.cutoff, bath.temperature)
            print(lever, crystal, *('%.6g' % number for number in numbers), *cold, *heated, sep=',', flush=True)


if __name__ == '__main__':
    main()

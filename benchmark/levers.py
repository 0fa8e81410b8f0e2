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
QUALITY_FACTOR, KICKS_OF_PAPER = 100, 11.09  # the file of the paper's lever has neither
MODEL = ('frequency_ratio', 'amplitude', 'rest_height', 'eta', 'cutoff')
RESULTS = ('lever_times_real_time', 'impacts_per_tau', 'search_failures')


def units_of(lever, crystal):
    constants = {}
    for path in ('levers/%s.yaml' % lever, 'surfaces/%s.yaml' % crystal):
        constants.update(yaml.safe_load((CONFIG / path).read_text()))
    return afm.Units(**{name: value for name, value in constants.items()
                        if name not in ('quality_factor', 'kicks_per_tau')})


def run(**settings):
    """A row for each drag speed, of the program real_time."""
    done = subprocess.run(['real_time', *('--%s=%s' % (name.replace('_', '-'), value)
                                          for name, value in settings.items())],
                          check=True, stdout=subprocess.PIPE, universal_newlines=True)
    return csv.DictReader(done.stdout.splitlines())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tau', type=int, default=300, help='measured time each')
    parser.add_argument('--transient', type=int, default=100, help='time before that')
    options = parser.parse_args()
    print('lever,crystal,load_nn,speed_um_per_s,tau_us', *MODEL, 'temperature',
          *(bath + name.replace('lever_', '') for bath in ('', 'heated_') for name in RESULTS), sep=',')
    for lever, crystal, load in itertools.product(LEVERS, CRYSTALS, LOADS):
        units = units_of(lever, crystal)
        scene = dict(vars(options), lever=lever, surface=crystal, load=1e-9 * load,
                     eta=','.join(repr(1e-6 * speed / units.velocity) for speed in SPEEDS))
        heat = {'temperature': 300.0 / units.temperature, 'quality_factor': QUALITY_FACTOR}
        if lever == 'paper':
            heat['kicks_per_tau'] = KICKS_OF_PAPER
        for speed, cold, heated in zip(SPEEDS, run(**scene, quality_factor=0), run(**scene, **heat)):
            numbers = (load, speed, 1e6 * units.time, *(float(cold[name]) for name in MODEL), heat['temperature'])
            print(lever, crystal, *('%.6g' % number for number in numbers), *(cold[name] for name in RESULTS),
                  *(heated[name] for name in RESULTS), sep=',', flush=True)


if __name__ == '__main__':
    main()

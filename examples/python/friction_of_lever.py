#!/usr/bin/python3
"""The friction of your lever on your crystal at 300 K, against the drag speed."""
import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import yaml

import afm

CONFIG = Path(__file__).resolve().parents[2] / 'config'
BY_SPRINGS = {'spring_constant_n_per_m', 'resonance_hz', 'lateral_spring_constant_n_per_m'}
BY_MODEL = {'omega_v_rad_per_s', 'omega_h_rad_per_s', 'tip_mass_kg'}
BATH = {'quality_factor', 'lateral_quality_factor', 'kicks_per_tau'}

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('lever', nargs='?', default='ppp_cont', help='a name in config/levers, or the path of a .yaml')
parser.add_argument('surface', nargs='?', default='nacl', help='a name in config/surfaces, or the path of a .yaml')
parser.add_argument('load_n', nargs='?', type=float, default=0.0, help='[N]')
parser.add_argument('duration', nargs='?', type=float, default=2000.0, help='of each drag speed [tau]')
options = parser.parse_args()


def read(kind, name, ways, more=frozenset()):
    """The numbers of a file, which has all the keys of one of the ways, and may have more."""
    path = Path(name) if name.endswith('.yaml') else CONFIG / kind / (name + '.yaml')
    try:
        # as texts: YAML would read 013000 as octal, and 1:30 as 90
        values = {key: float(value) for key, value in yaml.load(path.read_text(), yaml.BaseLoader).items()}
    except (OSError, yaml.YAMLError) as fault:
        parser.error('%s: %s' % (path, ' '.join(str(fault).split())))
    except (AttributeError, TypeError, ValueError):
        parser.error('%s: must hold lines of a key and a number' % path)
    if not any(way <= set(values) for way in ways):
        parser.error('%s: must have %s' % (path, ', or '.join(', '.join(sorted(way)) for way in ways)))
    foreign = set(values) - more.union(*ways)
    if foreign:
        parser.error('%s: says nothing of its %s by %s' % (path, kind[:-1], ', '.join(sorted(foreign))))
    return values


lever = read('levers', options.lever, (BY_SPRINGS, BY_MODEL), BATH)
surface = read('surfaces', options.surface, ({'lattice_spacing_m', 'surface_amplitude_m'},))
heat = {name: lever.pop(name) for name in BATH & set(lever)}
if not heat.get('quality_factor'):
    parser.error('%s: must have a quality_factor above 0: without one no bath heats it' % options.lever)
eta = np.arange(0.25, 8.1, 0.25)
try:
    units = afm.Units(load_n=options.load_n, **lever, **surface)
    curve = afm.friction_curve(eta, model=units.model, bath=units.bath(temperature_k=300.0, **heat),
                               duration=options.duration)
except (TypeError, afm.ParameterError) as fault:
    parser.error(str(fault).replace('\n', '; '))

speed, force = eta * units.velocity, eta * units.force  # K_f eta is the mean lateral force
plt.errorbar(1e6 * speed, 1e12 * curve['k_f_work'] * force, 1e12 * curve['k_f_work_std_error'] * force, fmt='.-')
plt.xlabel('drag speed [um/s]')
plt.ylabel('friction [pN]')
plt.savefig('friction_of_lever.png', dpi=120)

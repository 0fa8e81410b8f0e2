#!/usr/bin/python3
"""The friction of your lever on your crystal at 300 K. Arguments: the files of the lever and of the surface, the load
[N], and how long each drag speed is measured [tau]."""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import yaml

import afm

lever, surface, load_n, duration = (sys.argv[1:] + [None] * 4)[:4]
config = Path(__file__).resolve().parents[2] / 'config'
lever = yaml.safe_load(Path(lever or config / 'levers/ppp_cont.yaml').read_text())
surface = yaml.safe_load(Path(surface or config / 'surfaces/nacl.yaml').read_text())
heat = {name: lever.pop(name) for name in ('quality_factor', 'kicks_per_tau') if name in lever}
units = afm.Units(load_n=float(load_n or 0.0), **lever, **surface)

eta = np.arange(0.25, 8.1, 0.25)
curve = afm.friction_curve(eta, model=units.model, bath=units.bath(temperature_k=300.0, **heat),
                           duration=float(duration or 2000.0))
speed, force = eta * units.velocity, eta * units.force  # K_f eta is the mean lateral force
plt.errorbar(1e6 * speed, 1e12 * curve['k_f_work'] * force, 1e12 * curve['k_f_work_std_error'] * force, fmt='.-')
plt.xlabel('drag speed [um/s]')
plt.ylabel('friction [pN]')
plt.savefig('friction_of_lever.png', dpi=120)

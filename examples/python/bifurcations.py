#!/usr/bin/python3
"""A bifurcation diagram: where on the surface the tip lands, over drag speed. Argument: number of drag speeds."""
import sys

import matplotlib.pyplot as plt
import numpy as np

import afm

points = int(sys.argv[1]) if len(sys.argv) > 1 else 500
tip = afm.Tip(eta=2.9)
for eta in np.linspace(2.9, 1.7, points):  # the tip keeps to its attractor while there is one
    tip.drag(eta)
    tip.advance(float(tip.now) + 200)  # the transient
    events = tip.advance(float(tip.now) + 100)
    bounces = events[events['kind'] == afm.Kind.IMPACT]
    plt.plot(np.full(len(bounces), eta), bounces['surface_phase'], ',', color='black', alpha=0.5)
plt.xlabel(r'drag speed $\eta$ [a/$\tau$]')
plt.ylabel('surface phase of impacts [a]')
plt.savefig('bifurcations.png', dpi=120)

#!/usr/bin/python3
"""Heights of a tip at 300 K without drag, against the Boltzmann distribution above the surface.

Argument: number of samples. Restitution 1, as only then is the bath all that takes and gives energy.
"""
import sys

import matplotlib.pyplot as plt
import numpy as np

import afm

count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000000
model = afm.Model(gamma=1.0)
bath = afm.Units().bath(temperature_k=300.0, quality_factor=20.0)
tip = afm.Tip(model, eta=0.0, phase=0.0, bath=bath)  # the holder above a crest
tip.advance(1000.0)
heights = tip.samples(0.37, count).vertical  # of y0 = 0 [a]

edges = np.linspace(-0.1, 0.8, 91)
width = edges[1] - edges[0]
middle = 0.5 * (edges[:-1] + edges[1:])
counts, _ = np.histogram(heights, edges)

# theory: exp(-(omega_h^2 x^2 + omega_v^2 y^2) / 2 kT) where y lies above the surface H cos(2 pi x)
omega_v, omega_h = 2 * np.pi, 2 * np.pi * model.frequency_ratio
x, y = np.meshgrid(np.linspace(-0.5, 0.5, 2001), np.linspace(edges[0], edges[-1], 90 * 40 + 1)[:-1] + width / 80)
density = np.exp(-((omega_h * x) ** 2 + (omega_v * y) ** 2) / (2 * bath.temperature))
density[y < model.amplitude * np.cos(2 * np.pi * x)] = 0.0
theory = density.sum(axis=1).reshape(90, 40).sum(axis=1)
theory *= len(heights) / theory.sum()

distance = 0.5 * np.abs(counts - theory).sum() / len(heights)
print('total variation distance %.4f' % distance)
plt.step(middle, counts / (len(heights) * width), where='mid', label='simulated')
plt.plot(middle, theory / (len(heights) * width), label='Boltzmann')
plt.xlabel('height [a]')
plt.ylabel('probability density [1/a]')
plt.legend()
plt.savefig('thermal_histogram.png', dpi=120)

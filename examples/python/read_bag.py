#!/usr/bin/python3
"""A recording in numbers: the run in a bag is simulated again from its configuration and commands, and drawn.

Arguments: the bag, or in order those of a split recording. Needs ROS's Python modules: source devel/setup.bash first.
"""
import sys

import matplotlib.pyplot as plt
import numpy as np

import afm

recording = afm.from_bag(sys.argv[1:])
print(recording.model)
for command in recording.commands:
    print('%10.2f tau: %.4g um/s' % (command['tau'] + command['phase'], 1e6 * command['drag_velocity']))

run = recording.simulate()  # to the last bit what the node published, times a unit
units = recording.units
times = (run.impacts['tau'] + run.impacts['phase']) * units.time  # [s]
lost = np.cumsum(run.impacts['energy_loss']) * units.energy  # [J]
print('%d samples, %d impacts, %.4g J lost' % (len(run.vertical), len(run.impacts), lost[-1] if len(lost) else 0.0))
plt.plot(times, lost)
plt.xlabel('model time [s]')
plt.ylabel('energy lost in impacts [J]')
plt.savefig('read_bag.png', dpi=120)

#!/usr/bin/python3
"""FIG. 1 in ten lines: the friction coefficient against drag speed. Argument: how long each point is measured [tau]."""
import sys

import matplotlib.pyplot as plt
import numpy as np

import afm

duration = float(sys.argv[1]) if len(sys.argv) > 1 else 2000.0
curve = afm.friction_curve(np.arange(0.05, 9.0, 0.05), duration=duration, transient=0.5 * duration)
plt.errorbar(curve['eta'], curve['k_f_work'], curve['k_f_work_std_error'], fmt='.-', markersize=4, linewidth=0.8)
plt.xlabel(r'drag speed $\eta$ [a/$\tau$]')
plt.ylabel(r'$K_f$ [m_tip/$\tau$]')
plt.savefig('friction_peaks.png', dpi=120)

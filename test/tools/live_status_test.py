#!/usr/bin/python3
"""The line of live_status says what the messages say. usage: live_status_test.py SCRIPT"""
import runpy
import sys
import unittest

from afm_emulator.msg import EmulatorStatus, Friction


class LiveStatus(unittest.TestCase):
    status_line = staticmethod(runpy.run_path(sys.argv.pop())['status_line'])

    def test_the_line_has_the_figures_in_their_units(self):
        status = EmulatorStatus(impacts_per_tau=2.5, real_time_factor=0.9876)
        friction = Friction(drag_velocity=-6.6e-6, eta=-2., k_f_work=2e-6, k_f_work_std_error=1e-7, k_f_work_natural=.5)
        self.assertEqual(self.status_line(status), 'waiting for the first batch')
        self.assertEqual(self.status_line(status, friction),
                         '-6.600 um/s eta -2.000 K_f 0.5000+-0.0250 m_tip/tau 2.50 impacts/tau rtf 0.988')
        status, friction = EmulatorStatus(paused=True), Friction(k_f_work=float('nan'))
        self.assertEqual(self.status_line(status), 'paused')
        self.assertEqual(self.status_line(status, friction),
                         '0.000 um/s eta 0.000 K_f undefined at rest 0.00 impacts/tau rtf 0.000 paused')


unittest.main()

#!/usr/bin/python3
"""Ctrl-C ends every long call, and other threads of Python run meanwhile."""
import os
import signal
import subprocess
import sys
import unittest

import afm

DEADLINE_S = 20 * float(os.environ.get('AFM_PATIENCE', '1'))
# each would go on for hours
CALLS = {
    'friction_curve': 'afm.friction_curve([3.4] * 100, duration=1e10, threads=2)',
    'friction_curve with heat': 'afm.friction_curve(3.4, duration=1e10, temperature=1, quality_factor=100)',
    'attractors': 'afm.attractors(3.4, duration=1e8, transient=1e8)',
    'periodic_orbits': 'afm.periodic_orbits(3.4, max_length=30, guesses=1000000)',
    # held down: no event for ever
    'lyapunov in contact': 'afm.lyapunov(0.5, model=afm.Model(rest_height=-2.0), duration=1e10)',
    'lyapunov, before it is measured': 'afm.lyapunov(0.5, model=afm.Model(rest_height=-2.0), transient=1e10)',
    'attractors in contact': 'afm.attractors(0.5, rest_height=-2.0, duration=1e8, transient=1e8)',
    'friction_curve in contact': 'afm.friction_curve(0.5, rest_height=-2.0, duration=1e10, transient=1e10)',
    'Ensemble.advance in contact': 'afm.Ensemble([afm.Tip(afm.Model(rest_height=-2.0), eta=0.5)]).advance(1e10)',
    'Ensemble.advance of endless bounces': 'afm.Ensemble([afm.Tip(eta=0.2, contact_tolerance=0)]).advance(1e10)',
    'Run.advance by impacts': 'afm.Run(eta=0.2, contact_tolerance=0).advance(1e10, impacts=10**9)',
    'Run.advance in contact': 'afm.Run(afm.Model(rest_height=-2.0), eta=0.5, sample_period=1e6).advance(1e10)',
    'a batch in contact': 'afm.Run(afm.Model(rest_height=-2.0), eta=0.5, sample_period=1e6).advance()',
    'lyapunov': 'afm.lyapunov(3.4, duration=1e10, most_events=10**12)',
    'advance': 'afm.Tip().advance(1e10, most_events=10**12)',
    'samples': 'afm.Tip(afm.Model(gamma=0.0), eta=1.0).samples(1e5, 10**7)',
    'Run.advance': 'afm.Run(sample_period=1000.0, samples_per_batch=1).advance(1e10)',
}
PROGRAM = '''
import threading, signal, afm
signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Timer(0.5, lambda: print("under way", flush=True)).start()
try:
    %s
except KeyboardInterrupt:
    print("interrupted", flush=True)
'''


class Interrupt(unittest.TestCase):
    def test_every_long_call_ends(self):
        for name, call in CALLS.items():
            with self.subTest(name):
                self.check(PROGRAM % call)

    def check(self, program):
        process = subprocess.Popen([sys.executable, '-c', program], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   universal_newlines=True)
        try:
            # printed by another thread of Python: the call does not hold the interpreter
            self.assertEqual(process.stdout.readline(), 'under way\n')
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=DEADLINE_S)
            self.assertEqual((output, process.returncode), ('interrupted\n', 0))
        finally:
            process.kill()
            process.wait()
            process.stdout.close()

    def test_what_a_watcher_throws_ends_the_call(self):
        class Enough(Exception):
            pass

        def progress(done, points):
            self.assertEqual(points, 50)
            raise Enough

        with self.assertRaises(Enough):
            afm.friction_curve([3.4] * 50, duration=1e9, progress=progress)

    def test_a_watcher_sees_the_end(self):
        seen = []
        afm.friction_curve([2.0, 3.0], duration=10, transient=10, progress=lambda *counts: seen.append(counts))
        self.assertEqual(seen[-1], (2, 2))


if __name__ == '__main__':
    unittest.main()

#!/usr/bin/python3
"""plot_run.py draws a bag, and says what is wrong with what is none. usage: plot_run_test.py SCRIPT"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosbag
from afm_emulator.msg import Applied, Configuration, Deflection, Friction, Impact, ImpactArray

SCRIPT = sys.argv.pop()


def plot(*arguments):
    return subprocess.run([sys.executable, SCRIPT] + [str(a) for a in arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


class PlotRun(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.directory = Path(holder.name)

    def bag(self, batches):
        path = self.directory / 'run.bag'
        with rosbag.Bag(str(path), 'w') as bag:
            for epoch in range(2):
                configuration = Configuration(epoch=epoch, omega_v_rad_per_s=40e3, lattice_spacing_m=0.52e-9,
                                              restitution_gamma=0.7, cutoff_speed=1.66e-7, sample_rate_hz=1e5)
                configuration.header.seq = epoch
                bag.write('/tip/configuration', configuration)
                drag = Applied(epoch=epoch, drag_velocity=6.6e-6)
                drag.header.seq = epoch
                bag.write('/tip/applied', drag)
                for i in range(batches):
                    deflection = Deflection(epoch=epoch, first_sample=100 * i, sample_period=1e-5,
                                            vertical=[1e-10] * 100, lateral=[-1e-11] * 100)
                    deflection.time.tau = 6 * i
                    bag.write('/tip/deflection', deflection)
                    bag.write('/tip/impacts', ImpactArray(epoch=epoch, impacts=[Impact(normal_speed=1e-6, kind=k)
                                                                              for k in range(4)]))
                    bag.write('/tip/friction', Friction(epoch=epoch, k_f_work=1e-6, k_f_work_natural=0.4))
        return path

    def test_draws_beside_the_bag_or_where_asked(self):
        path = self.bag(20)
        done = plot(path)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(Path(done.stdout.split()[-1]), path.with_suffix('.png'))
        picture = self.directory / 'other.svg'
        done = plot(path, '--output', picture, '--from', 0.001, '--until', 0.01)
        self.assertEqual(done.returncode, 0, done.stdout)
        for label in ('deflection', 'normal speed', 'drag speed', 'model time'):
            self.assertIn('<!-- ' + label, picture.read_text())
        self.assertEqual(path.with_suffix('.png').read_bytes()[:4], b'\x89PNG')

    def test_says_what_is_wrong(self):
        text = self.directory / 'text.bag'
        text.write_text('no bag')
        for path, words in ((text, 'text.bag'), ('/nowhere.bag', 'No such file'), (self.bag(0), 'no run')):
            done = plot(path)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stdout)
            self.assertNotIn('Traceback', done.stdout)


if __name__ == '__main__':
    unittest.main()

#!/usr/bin/python3
"""plot_run.py draws a bag, and says what is wrong with what is none. usage: plot_run_test.py SCRIPT"""
import itertools
import re
import runpy
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosbag
from afm_emulator.msg import Applied, Configuration, Deflection, Friction, Impact, ImpactArray
from numpy.testing import assert_allclose

SCRIPT = sys.argv.pop()


def plot(*arguments):
    return subprocess.run([sys.executable, SCRIPT] + [str(a) for a in arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


class PlotRun(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.directory = Path(holder.name)

    def bag(self, batches, name='run.bag', nodes=('/tip',), eta=1.0, lost=(), sample_period=1e-5,
            gammas=(0.7, 0.7)):
        path = self.directory / name
        with rosbag.Bag(str(path), 'w') as bag:
            def write(node, topic, message, seq):
                message.header.seq = seq
                bag.write(node + topic, message, connection_header=dict(
                    topic=node + topic, callerid=node, type=message._type, md5sum=message._md5sum,
                    message_definition=message._full_text))
            for epoch, node in itertools.product(range(2), nodes):
                configuration = Configuration(epoch=epoch, omega_v_rad_per_s=40e3, lattice_spacing_m=0.52e-9,
                                              restitution_gamma=0.7, cutoff_speed=1.66e-7, sample_rate_hz=1e5)
                write(node, '/configuration', configuration, epoch)
                write(node, '/applied', Applied(epoch=epoch, drag_velocity=6.6e-6 * eta, cutoff_speed=1.66e-7,
                                                restitution_gamma=gammas[epoch], sample_rate_hz=1e5), epoch)
                for i in range(batches):
                    deflection = Deflection(epoch=epoch, first_sample=100 * i, sample_period=sample_period,
                                            vertical=[1e-10, 2e-10] * 50, lateral=[-1e-11, -3e-11] * 50)
                    deflection.time.tau = int(6e5 * sample_period * i)
                    deflection.time.phase = 6e5 * sample_period * i - deflection.time.tau
                    impacts = ImpactArray(epoch=epoch, impacts=[
                        Impact(normal_speed=speed, kind=k) for k, speed in enumerate((1e-6, 2e-6, 0.0, 0.0))])
                    friction = Friction(epoch=epoch, k_f_work=1e-6, k_f_work_std_error=1e-7, k_f_work_natural=0.4)
                    for topic, message in (('/deflection', deflection), ('/impacts', impacts), ('/friction', friction)):
                        if (topic, batches * epoch + i) in lost:
                            continue
                        write(node, topic, message, batches * epoch + i)
        return path

    def test_draws_beside_the_bag_or_where_asked(self):
        path = self.bag(20)
        done = plot(path)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(Path(done.stdout.split()[-1]), path.with_suffix('.png'))
        picture = self.directory / 'other.svg'
        done = plot(path, '--output', picture)
        self.assertEqual(done.returncode, 0, done.stdout)
        for label in ('deflection', 'normal speed', 'drag speed', 'model time'):
            self.assertIn('<!-- ' + label, picture.read_text())
        self.assertEqual(path.with_suffix('.png').read_bytes()[:4], b'\x89PNG')

    def test_what_is_drawn_has_the_units_of_its_axes(self):
        script, path = runpy.run_path(SCRIPT), str(self.bag(20))
        run = script['read']([path], None)
        assert_allclose([*run.samples[0][:, 1], *run.drag[0], *run.friction[0][:3]],
                        [2e-5, 0.1, -0.03, 0.2, -0.01, 0.0, 6.6, 0.0, 0.4, 0.04])  # of every two samples the range
        figure = script['draw'](run, [path])
        figure.canvas.draw()
        *spots, epochs = figure.axes[1].collections
        self.assertEqual(len(epochs.get_segments()), 1)
        self.assertEqual([(kind.get_label(), kind.get_offsets()[0, 1]) for kind in spots],
                         [('impact', 1.0), ('chatter sequence', 2.0), ('contact begins', 0.03), ('contact ends', 0.07)])
        eta, = figure.axes[3].child_axes
        assert_allclose(figure.axes[3].get_ylim(), [3.31042281631 * v for v in eta.get_ylim()], rtol=1e-9)

    def test_the_title_says_what_was_in_force(self):
        """It said what the run began with."""
        script = runpy.run_path(SCRIPT)
        for gammas, said in (((0.4, 0.4), '0.4'), ((0.75, 0.4), '0.4 to 0.75')):
            run = script['read']([str(self.bag(2, gammas=gammas))], None)
            self.assertEqual(run.title(), '$\\gamma$ = %s, $v_c$ = 0.166 $\\mu$m/s, 100 kHz' % said)

    def test_a_gap_is_drawn_and_said(self):
        """The line went across it, in the last tau too."""
        whole, gap = (self.bag(20, name, lost=lost, sample_period=1e-6) for name, lost in
                      (('whole.bag', ()), ('gap.bag', [('/deflection', 36), ('/deflection', 37)])))
        self.assertEqual(plot(whole, '--output', self.directory / 'whole.svg').returncode, 0)
        done = plot(gap, '--output', self.directory / 'gap.svg')
        self.assertEqual(done.returncode, 3, done.stdout)
        self.assertIn('warning: 2 messages of Deflection are missing', done.stdout)

        def strokes(name):  # of all lines: each begins by a move
            return len(re.findall(r'[\s"]M ', (self.directory / name).read_text()))
        self.assertEqual(strokes('gap.svg'), strokes('whole.svg') + 4)  # vertical and lateral

    def test_what_comes_before_the_first_configuration_is_drawn_too(self):
        """It was left out without a word."""
        whole, cut = self.bag(20), self.directory / 'cut.bag'
        with rosbag.Bag(str(whole)) as source, rosbag.Bag(str(cut), 'w') as bag:
            for topic, raw, stamp, header in source.read_messages(raw=True, return_connection_header=True):
                message = raw[4]().deserialize(raw[1])
                if topic != '/tip/configuration' or message.epoch == 1:
                    bag.write(topic, message, stamp, connection_header=header)
        for path in (whole, cut):
            done = plot(path, '--output', path.with_suffix('.svg'))
            self.assertEqual(done.returncode, 0, done.stdout)
        drawn = [path.with_suffix('.svg').read_text() for path in (whole, cut)]
        self.assertEqual(*(len(re.findall(r'[\s"][ML] ', text)) for text in drawn))

    def test_a_bag_of_another_version_is_refused_by_name(self):
        for kind in (Configuration, Friction):
            path = self.bag(2)
            path.write_bytes(path.read_bytes().replace(kind._md5sum.encode(), b'0' * 32))
            done = plot(path)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn('another version of ' + kind._type, done.stdout)

    def test_says_what_is_wrong(self):
        text = self.directory / 'text.bag'
        text.write_text('no bag')
        good, two = self.bag(5), self.bag(5, 'two.bag', nodes=('/tip', '/other'))
        for arguments, words in (([text], 'text.bag'), (['/nowhere.bag'], 'No such file'), ([''], 'invalid'),
                                 ([self.bag(0, 'empty.bag')], 'no run'), ([good, '--node', '/other'], 'no run'),
                                 ([two], 'choose one emulator by --node'),
                                 ([good, self.bag(5, 'again.bag', eta=2.0)], 'started again'),
                                 ([good, '--output', '/nowhere/run.png'], 'No such file'),
                                 ([good, '--output', self.directory / 'run.nothing'], 'not supported')):
            with self.subTest(words=words):
                done = plot(*arguments)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(words, done.stdout)
                self.assertNotIn('Traceback', done.stdout)
        self.assertEqual(plot(two, '--node', '/other').returncode, 0)


if __name__ == '__main__':
    unittest.main()

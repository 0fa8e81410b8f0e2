#!/usr/bin/python3
"""Plays every shipped scene for some seconds with a master of its own, records it, and draws what one sees: the
deflection over a few tau with its impacts, and the friction. Needs the package built and its setup.bash sourced.

Usage: scenes.py --output DIRECTORY [SCENE...]     (scene_SCENE.png of each)"""
import argparse
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import matplotlib
    matplotlib.use('Agg')
    import numpy as np
    import rosbag
    from matplotlib import pyplot
except ImportError as missing:
    sys.exit('scenes: %s; scripts/install_dependencies installs it (Debian: python3-rosbag, python3-matplotlib)'
             % missing)

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from plot_run import KINDS  # noqa: E402

# seconds to record, the tau that are drawn, and what one sees
SCENES = {'paper': (4, 4000, 4008, 'bounces that never repeat, $\\eta$ = 3.4'),
          'resonance': (3, 4000, 4004, 'the same impacts for ever, $\\eta$ = 2'),
          'splash': (3, 4000, 4004, 'showers of small bounces, $\\eta$ = 3'),
          'glide': (3, 1000, 1004, 'the path on the surface is a free flight, $\\eta$ = 1'),
          'rest': (3, 0, 4, 'bounces that die out without a drag'),
          'sweep': (9, 4000, 4004, 'friction depends on the direction, $\\eta$ about 5.65'),
          'slow_motion': (11, 0, 4.5, 'single flights, $\\eta$ = 3.4'),
          'room': (4, 4000, 4008, 'the orbit of $\\eta$ = 2 at 300 K'),
          'loop': (12, 45000, 47000, 'trace and retrace at 300 K, $|\\eta|$ = 2')}
CONFIG = ROOT / 'config'
SAMPLE_RATE_HZ = 1e6  # for the picture: 25 samples to a turn of the horizontal spring
PATIENCE_S = 60.0  # for a busy machine to start a node
FRICTION_UNIT = 408e-12 * 40e3 / (2 * np.pi)  # kg/s for 1 m_tip/tau
TAU_S = 2 * np.pi / 40e3
LATERAL_SPRING = 408e-12 * 250e3 ** 2  # N/m


def free_port():
    with socket.socket() as free:
        free.bind(('localhost', 0))
        return free.getsockname()[1]


def record(scene, seconds, directory):
    environment = dict(os.environ, ROS_MASTER_URI='http://localhost:%d' % free_port())
    finer = Path(directory) / (scene + '.yaml')
    finer.write_text(re.sub('sample_rate_hz: .*', 'sample_rate_hz: %.1f' % SAMPLE_RATE_HZ,
                            (CONFIG / 'scenes' / finer.name).read_text()))
    bags = Path(directory) / 'bags'
    command = ['roslaunch', '-p', environment['ROS_MASTER_URI'].rsplit(':', 1)[1], 'afm_emulator', 'emulator.launch',
               'scene_file:=%s' % finer, 'record:=true', 'bag_directory:=%s' % bags]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, start_new_session=True) as launch:
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end and launch.poll() is None:
            time.sleep(0.05)
            if end > time.monotonic() + seconds and any(bags.glob('*')):  # the node runs
                end = time.monotonic() + seconds
        launch.send_signal(signal.SIGINT)
    if not list(bags.glob('*.bag')):
        sys.exit('scenes: %s: nothing was recorded; roslaunch ended with code %d' % (scene, launch.returncode))
    return next(bags.glob('*.bag'))


def tau(time):
    return time.tau + time.phase


class Recorded:
    def __init__(self, path, begin, end):
        self.samples, self.events, self.friction, self.drags = [], [], [], []
        self.configuration = None
        with rosbag.Bag(str(path)) as bag:
            for topic, message, _ in bag.read_messages():
                kind = topic.rsplit('/', 1)[1]
                if kind == 'deflection' and tau(message.time) < end:
                    self.add_samples(message, begin, end)
                elif kind == 'impacts' and tau_of_first(message) < end:
                    self.events += [i for i in message.impacts if begin <= tau(i.time) < end]
                elif kind == 'friction':
                    self.friction.append((tau(message.time), message.eta, message.k_f_natural,
                                          message.window_k_f / FRICTION_UNIT, message.k_f_work / FRICTION_UNIT))
                elif kind == 'configuration':
                    self.configuration = message
                elif kind == 'applied':
                    self.drags.append((tau(message.time), message))

    def add_samples(self, message, begin, end):
        period = message.sample_period * 40e3 / (2 * np.pi)
        times = tau(message.time) + period * np.arange(len(message.vertical))
        inside = (times >= begin) & (times < end)
        self.samples.append(np.array([times, message.vertical, message.lateral])[:, inside])


def tau_of_first(message):
    return tau(message.impacts[0].time) if message.impacts else np.inf


MOST_TAU = 12.0  # of the deflection that is drawn


def draw_deflection(axes, run):
    times, vertical, lateral = np.hstack(run.samples)
    shown = times < times[0] + MOST_TAU
    times, vertical, lateral = times[shown], vertical[shown], lateral[shown]
    style = {'lw': 0.9} if len(times) > 600 else {'lw': 0.4, 'marker': '.',
                                                  'ms': 4}  # where single samples are seen, as such
    axes.plot(times, vertical * 1e9, label='vertical', **style)
    axes.plot(times, lateral * 1e9, label='lateral', alpha=0.8, **style)
    axes.margins(y=0.1)
    for kind, (name, colour, _) in KINDS.items():
        found = [tau(i.time) for i in run.events if i.kind == kind and tau(i.time) < times[-1]]
        if found:
            axes.plot(found, np.full(len(found), 0.03), '|', ms=9, c='C%d' % (kind + 2), label='%s' % name,
                      transform=axes.get_xaxis_transform())
    axes.set_xlabel('model time [tau]')
    axes.set_ylabel('deflection [nm]')
    axes.legend(loc='lower right', bbox_to_anchor=(1, 1), ncol=5, frameon=False, borderaxespad=0.1, fontsize=8)


def draw_friction(axes, run):
    times, _, mean, window, work = np.array(run.friction).T
    heated = run.configuration.quality_factor > 0
    axes.plot(times, window, lw=0.8, c='0.6', label='sliding window')
    if heated:
        axes.plot(times, mean, lw=1.0, label='from impacts')
        mean = work
    axes.plot(times, mean, lw=1.3, label='from the work of the drag' if heated else 'since the last command')
    if np.isnan(mean).all():
        axes.text(0.5, 0.5, 'without drag $K_f$ is not defined', transform=axes.transAxes, ha='center')
    top = max(0.01, 1.6 * mean[-1]) if mean[-1] > 0 else 0.01
    axes.set_ylim(-0.03 * top, top)  # friction that is nothing is seen too
    axes.xaxis.set_major_locator(pyplot.MaxNLocator(5))
    axes.set_xlabel('model time [tau]')
    axes.legend(frameon=False, fontsize=8)


def draw_sweep(axes, run):
    """The last estimate before each command, by the direction it was come from."""
    friction = np.array(run.friction)
    points = []
    for (begin, _), (end, _) in zip(run.drags[1:], run.drags[2:]):
        held = friction[(friction[:, 0] > begin) & (friction[:, 0] <= end)]
        points.append((held[-1, 1], held[-1, 2]))
    eta, K = np.array(points).T
    top = int(np.argmax(eta))
    near = axes.inset_axes([0.52, 0.1, 0.45, 0.5])
    near.set_xlim(5.62, 5.672)
    near.set_ylim(0.6, 1.32)
    near.tick_params(labelsize=7)
    for ax in (axes, near):
        ax.plot(eta[:top + 1], K[:top + 1], '-^', ms=4, lw=0.9, label='on the way up')
        ax.plot(eta[top:], K[top:], '-v', ms=4, lw=0.9, label='and down')
    axes.set_xlabel('$\\eta$')
    axes.set_yscale('log')
    axes.legend(frameon=False, fontsize=8)


def draw_loop(axes, run):
    """The lateral force over the holder's position, sampled and averaged, one forth and back."""
    times, _, lateral = np.hstack(run.samples)
    turns = [(at, message.drag_velocity) for at, message in run.drags]
    first = next(i for i, (at, velocity) in enumerate(turns) if at > times[0] and velocity > 0)
    back, end = turns[first + 1][0], turns[first + 2][0]
    speed = turns[first][1]
    force, mean = -LATERAL_SPRING * lateral * 1e9, []
    for name, begin, stop, sign in (('trace', turns[first][0], back, 1), ('retrace', back, end, -1)):
        inside = (times >= begin) & (times < stop)
        position = speed * TAU_S * (times[inside] - begin) * 1e9
        position = position if sign > 0 else position[-1] - position
        bins = np.arange(0, 10 * (position.max() // 10), 10.0)
        which = np.digitize(position, bins)
        steady = times[inside] > begin + 60  # without the change of direction
        mean.append(force[inside][steady].mean())
        axes.plot(bins + 5, [force[inside][which == i + 1].mean() for i in range(len(bins))], lw=1.4,
                  label='%s, mean %.3g nN' % (name, mean[-1]))
    half, k_f = 0.5 * (mean[0] - mean[1]), [f[4] for f in run.friction if f[0] > turns[first][0]][-1]
    axes.axhline(0, color='black', lw=0.5)
    axes.set_title('half the opening %.3g nN; K_f v0 = %.3g nN' % (half, 1e9 * k_f * FRICTION_UNIT * speed), fontsize=9)
    axes.set_xlabel('position of the holder [nm]')
    axes.set_ylabel('lateral force [nN],\nmeans over 10 nm')
    axes.legend(frameon=False, fontsize=8, loc='center')


def draw_path(axes, run):
    """The tip's path over the surface, from a run without changes of the drag velocity."""
    times, vertical, lateral = np.hstack(run.samples)
    c = run.configuration
    place = c.initial_phase - c.initial_extension + run.friction[-1][1] * times + lateral / c.lattice_spacing_m
    place -= np.floor(place[0])
    axes.fill_between(place, 1e9 * c.surface_amplitude_m * np.cos(2 * np.pi * place), -0.08, color='0.8',
                      label='surface')
    axes.plot(place, vertical * 1e9, lw=1.3, label='tip')
    axes.set_xlabel('x [a]')
    axes.set_ylabel('y [nm]')
    axes.legend(frameon=False, fontsize=8, ncol=2, loc='lower center')


def draw_speeds(axes, run):
    bounces = [(tau(i.time), i.normal_speed) for i in run.events if i.normal_speed > 0]
    axes.semilogy(*zip(*[(t, v * 1e6) for t, v in bounces]), '.', ms=4)
    axes.set_xlabel('model time [$\\tau$]')
    axes.set_ylabel('normal speed of\nimpacts [$\\mu$m/s]')


def draw(scene, run, output):
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 3.2), constrained_layout=True,
                                            gridspec_kw={'width_ratios': [3, 2]})
    draw_deflection(left, run)
    right.set_ylabel('$K_f$ [$m_{tip}$/$\\tau$]')
    {'sweep': draw_sweep, 'loop': draw_loop, 'glide': draw_path,
     'rest': draw_speeds}.get(scene, draw_friction)(right, run)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.suptitle('Scene "%s": %s' % (scene, SCENES[scene][3]), x=0.01, ha='left', fontsize=11)
    figure.savefig(output, dpi=80)
    pyplot.close(figure)
    print(output, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scenes', nargs='*', metavar='SCENE', help='default: all')
    parser.add_argument('--output', required=True)
    arguments = parser.parse_args()
    for scene in arguments.scenes or SCENES:
        if scene not in SCENES:
            parser.error('there is no scene %s; there are %s' % (scene, ', '.join(SCENES)))
        seconds, begin, end, _ = SCENES[scene]
        with tempfile.TemporaryDirectory() as directory:
            run = Recorded(record(scene, seconds, directory), begin, end)
        draw(scene, run, os.path.join(arguments.output, 'scene_%s.png' % scene))


if __name__ == '__main__':
    main()

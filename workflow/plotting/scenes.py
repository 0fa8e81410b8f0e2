#!/usr/bin/python3
"""Plays every shipped scene for some seconds with a master of its own, records it, and draws what one sees: the
deflection over a few tau with its impacts, and the path over the surface. Needs the package built and its setup.bash
sourced.

Usage: scenes.py --output DIRECTORY [SCENE...]     (scene_SCENE.png of each)"""
import argparse
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
    import rosbag
except ImportError as missing:
    sys.exit('scenes: %s; scripts/install_dependencies installs it (Debian: python3-rosbag, python3-matplotlib)'
             % missing)

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'workflow'), str(ROOT / 'scripts')]
from own_master import free_port  # noqa: E402
from plotting import style  # noqa: E402

# seconds to record, and the tau that are drawn
SCENES = {'paper': (4, 4000, 4008), 'resonance': (3, 4000, 4004), 'splash': (3, 4000, 4004), 'glide': (3, 1000, 1004),
          'rest': (3, 0, 4), 'sweep': (9, 4000, 4004), 'slow_motion': (11, 0, 4.5), 'room': (4, 4000, 4008),
          'loop': (12, 45000, 47000)}
# name, sign and colour of the kinds of events
KINDS = {0: ('impact', 'o', 'black'), 1: ('chatter sequence', 'D', style.GREEN), 2: ('contact begins', '>', style.PINK),
         3: ('contact ends', '<', style.PINK)}
CONFIG = ROOT / 'config'
SAMPLE_RATE_HZ = 1e6  # for the picture: 25 samples to a turn of the horizontal spring
PATIENCE_S = 60.0  # for a busy machine to start a node
FRICTION_UNIT = 408e-12 * 40e3 / (2 * np.pi)  # kg/s for 1 m_tip/tau
TAU_S = 2 * np.pi / 40e3
LATERAL_SPRING = 408e-12 * 250e3 ** 2  # N/m


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


MOST_TAU, MOST_CELLS = 8.0, 8.0  # of the deflection and of the path that are drawn


def draw_deflection(axes, run):
    times, vertical, lateral = np.hstack(run.samples)
    shown = times < times[0] + MOST_TAU
    times, vertical, lateral = times[shown], vertical[shown], lateral[shown]
    begin = np.floor(times[0])
    line = {} if len(times) > 600 else {'marker': '.', 'ms': 4}  # where single samples are seen, as such
    axes.plot(times - begin, vertical * 1e9, lw=1.2, color=style.BLUE, label='vertical', **line)
    axes.plot(times - begin, lateral * 1e9, lw=1.0, color=style.ORANGE, label='lateral', **line)
    low = min(vertical.min(), lateral.min()) * 1e9
    high = max(vertical.max(), lateral.max()) * 1e9
    axes.set_ylim(low - 0.22 * (high - low), high + 0.06 * (high - low))
    for kind, (name, sign, colour) in KINDS.items():
        found = [tau(i.time) - begin for i in run.events if i.kind == kind and tau(i.time) < times[-1]]
        if found:
            look = dict(marker='|', ms=9) if kind == 0 else dict(marker=sign, ms=5)
            axes.plot(found, np.full(len(found), 0.05 + 0.06 * (kind > 0)), linestyle='none', color=colour, label=name,
                      transform=axes.get_xaxis_transform(), **look)
    axes.set_xlabel('model time [$\\tau$]' if begin == 0 else 'model time after %d $\\tau$ [$\\tau$]' % begin)
    axes.set_ylabel('deflection [nm]')
    axes.legend(loc='lower right', bbox_to_anchor=(1, 1), ncol=5, borderaxespad=0.1, handletextpad=0.3,
                columnspacing=0.8, handlelength=1.2)


def place_of(run, times, lateral):
    """Positions [a] of samples, from a run without changes of the drag velocity; the first cell is 0."""
    c = run.configuration
    place = c.initial_phase - c.initial_extension + run.friction[-1][1] * times + lateral / c.lattice_spacing_m
    return place - np.floor(place[0])


def draw_path(axes, run):
    """The tip's path over the surface."""
    times, vertical, lateral = np.hstack(run.samples)
    c = run.configuration
    place = place_of(run, times, lateral)
    shown = place < place[0] + MOST_CELLS
    place, vertical, times = place[shown], vertical[shown], times[shown]
    amplitude = 1e9 * c.surface_amplitude_m
    xs = np.linspace(place.min(), place.max(), 2000)
    axes.fill_between(xs, amplitude * np.cos(2 * np.pi * xs), -2.2 * amplitude, color=style.SOLID)
    axes.plot(xs, amplitude * np.cos(2 * np.pi * xs), color=style.GREY, lw=1.0)
    axes.plot(place, vertical * 1e9 + 1e9 * c.rest_height_m, lw=1.3, color=style.BLUE)
    hits = np.array([tau(i.time) for i in run.events if i.kind == 0 and tau(i.time) < times[-1]])
    if len(hits):
        axes.plot(np.interp(hits, times, place), np.interp(hits, times, vertical) * 1e9 + 1e9 * c.rest_height_m, 'o',
                  color='black', ms=3.5)
    axes.set_xlim(xs[0], xs[-1])
    axes.set_ylim(bottom=-2.2 * amplitude)
    axes.set_xlabel('position x [a]')
    axes.set_ylabel('height y [nm]')
    axes.set_title('path of the tip over the surface', loc='left')


def draw_sweep(axes, run):
    """The last estimate before each command, by the direction it was come from."""
    friction = np.array(run.friction)
    points = []
    for (begin, _), (end, _) in zip(run.drags[1:], run.drags[2:]):
        held = friction[(friction[:, 0] > begin) & (friction[:, 0] <= end)]
        points.append((held[-1, 1], held[-1, 2]))
    eta, K = np.array(points).T
    top = int(np.argmax(eta))
    axes.plot(eta[:top + 1], K[:top + 1], '-^', ms=5, lw=1.0, color=style.BLUE, label='$\\eta$ rising')
    axes.plot(eta[top:], K[top:], '--v', ms=5, lw=1.0, color=style.ORANGE, label='$\\eta$ falling', **style.OPEN)
    axes.set_xlabel(style.ETA_LABEL)
    axes.set_ylabel(style.K_F_LABEL)
    axes.set_yscale('log')
    style.legend_above(axes)


def draw_loop(axes, run):
    """The lateral force over the holder's position, sampled and averaged, once there and back."""
    times, _, lateral = np.hstack(run.samples)
    turns = [(at, message.drag_velocity) for at, message in run.drags]
    first = next(i for i, (at, velocity) in enumerate(turns) if at > times[0] and velocity > 0)
    back, end = turns[first + 1][0], turns[first + 2][0]
    speed = turns[first][1]
    force, mean = -LATERAL_SPRING * lateral * 1e9, []
    for name, begin, stop, sign, look in (('trace', turns[first][0], back, 1, dict(color=style.BLUE, ls='-')),
                                          ('retrace', back, end, -1, dict(color=style.ORANGE, ls='--'))):
        inside = (times >= begin) & (times < stop)
        position = speed * TAU_S * (times[inside] - begin) * 1e9
        position = position if sign > 0 else position[-1] - position
        bins = np.arange(0, 10 * (position.max() // 10), 10.0)
        which = np.digitize(position, bins)
        steady = times[inside] > begin + 60  # without the change of direction
        mean.append(force[inside][steady].mean())
        axes.plot(bins + 5, [force[inside][which == i + 1].mean() for i in range(len(bins))], lw=1.4,
                  label='%s, mean %.3g nN' % (name, mean[-1]), **look)
        axes.axhline(mean[-1], lw=0.8, **look)
    half, k_f = 0.5 * (mean[0] - mean[1]), [f[4] for f in run.friction if f[0] > turns[first][0]][-1]
    axes.axhline(0, color='black', lw=0.6)
    axes.set_title('half the opening %.3g nN; $K_f v_0$ = %.3g nN' % (half, 1e9 * k_f * FRICTION_UNIT * speed),
                   loc='left')
    axes.set_xlabel('position of the holder [nm]')
    axes.set_ylabel('lateral force, means over 10 nm [nN]')
    axes.legend(loc='center')


def draw_speeds(axes, run):
    bounces = [(tau(i.time), i.normal_speed) for i in run.events if i.normal_speed > 0]
    axes.semilogy(*zip(*[(t, v * 1e6) for t, v in bounces]), 'o', ms=4, color='black')
    axes.set_xlabel('model time [$\\tau$]')
    axes.set_ylabel('normal speed of impacts [$\\mu$m/s]')


def draw(scene, run, output):
    figure, (left, right) = style.new(3.3, 1, 2)
    draw_deflection(left, run)
    {'sweep': draw_sweep, 'loop': draw_loop, 'rest': draw_speeds}.get(scene, draw_path)(right, run)
    figure.savefig(output)
    print(output, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scenes', nargs='*', metavar='SCENE', help='default: all')
    parser.add_argument('--output', required=True)
    arguments = parser.parse_args()
    for scene in arguments.scenes or SCENES:
        if scene not in SCENES:
            parser.error('there is no scene %s; there are %s' % (scene, ', '.join(SCENES)))
        seconds, begin, end = SCENES[scene]
        with tempfile.TemporaryDirectory() as directory:
            run = Recorded(record(scene, seconds, directory), begin, end)
        draw(scene, run, os.path.join(arguments.output, 'scene_%s.png' % scene))


if __name__ == '__main__':
    main()

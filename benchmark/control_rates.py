#!/usr/bin/python3
"""How many control periods a second a controller makes in lockstep, from C++ and Python, cold and at 300 K: starts a
master and an emulator of its own. Writes the table of docs/controllers.md.

usage: control_rates.py [--periods N] [--output FILE]     (default: 2000, docs/data/control_rates.csv)"""
import argparse
import os
import signal
import subprocess
import sys
import time
import xmlrpc.client
from pathlib import Path

from loop_delay import binary, wait_for
from record_throughput import free_port

# at eta = 3.4
SCENES = {'cold': {}, '300 K and Q = 100': {'temperature_k': 300.0, 'quality_factor': 100.0}}
DURATIONS_S = (0.0001, 0.001, 0.01, 0.1)


def measure_python(duration, periods):
    import rospy
    from afm_emulator import Client
    if not rospy.core.is_initialized():
        rospy.init_node('control_rates', anonymous=True, disable_rostime=True)
    tip = Client('/afm')
    tip.control(duration)
    begin = time.monotonic()
    for _ in range(periods):
        tip.control(duration)
    return periods / (time.monotonic() - begin)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--periods', type=int, default=2000)
    parser.add_argument('--output', type=Path,
                        default=Path(__file__).resolve().parent.parent / 'docs/data/control_rates.csv')
    arguments = parser.parse_args()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % free_port()
    master = subprocess.Popen(['rosmaster', '--core', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]])
    lines = ['tip,period / ms,C++: periods a second,C++: times real time,'
             'Python: periods a second,Python: times real time']
    try:
        server = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        wait_for(server)
        for scene, parameters in SCENES.items():
            for duration in DURATIONS_S:
                periods = min(arguments.periods, int(30.0 / duration))  # 30 s of model time are enough
                server.setParam('control_rates', '/afm',
                                dict(parameters, pace='lockstep', drag_velocity=1.1255437575458838e-05))
                emulator = subprocess.Popen([binary('emulator_node'), '__name:=afm'])
                try:
                    cpp = float(subprocess.check_output([binary('control_rate'), '_duration:=%g' % duration,
                                                         '_periods:=%d' % periods], text=True).split()[-1])
                    python = measure_python(duration, periods)
                finally:
                    emulator.send_signal(signal.SIGINT)
                    emulator.wait()
                lines.append('%s,%g,%.0f,%.2g,%.0f,%.2g' %
                             (scene, 1e3 * duration, cpp, cpp * duration, python, python * duration))
                print(lines[-1], file=sys.stderr)
    finally:
        master.kill()
    arguments.output.write_text('\n'.join(lines) + '\n')
    print('\n'.join(lines))


if __name__ == '__main__':
    main()

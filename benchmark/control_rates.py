#!/usr/bin/python3
"""How many control periods a second a controller makes in lockstep, from C++ and Python, cold and at 300 K: starts a
master and an emulator of its own. Prints the table of docs/controllers.md.

usage: control_rates.py [--periods N]     (default: 2000)"""
import itertools
import subprocess
import time

from emulator import binary, emulator, option, own_master

# at eta = 3.4
SCENES = {'no bath': {}, '300 K and Q = 100': {'temperature_k': 300.0, 'quality_factor': 100.0}}
DURATIONS_S = (0.0001, 0.001, 0.01, 0.1)


def measure_python(duration, periods):
    import rospy
    from afm_emulator import Client
    if not rospy.core.is_initialized():
        rospy.init_node('control_rates', anonymous=True, disable_rostime=True)
    tip = Client('/afm')
    for _ in range(periods // 4):
        tip.control(duration)
    begin = time.monotonic()
    for _ in range(periods):
        tip.control(duration)
    return periods / (time.monotonic() - begin)


def main():
    most_periods = option(__doc__, 'periods', 2000)
    print('tip,period / ms,C++: periods a second,C++: times real time,'
          'Python: periods a second,Python: times real time')
    with own_master() as server:
        for (scene, parameters), duration in itertools.product(SCENES.items(), DURATIONS_S):
            periods = min(most_periods, int(30.0 / duration))  # 30 s of model time are enough
            with emulator(server, dict(parameters, pace='lockstep', drag_velocity=1.1255437575458838e-05)):
                cpp = float(subprocess.check_output([binary('control_rate'), '_duration:=%g' % duration,
                                                     '_periods:=%d' % periods], text=True).split()[-1])
                python = measure_python(duration, periods)
            print('%s,%g,%.0f,%.2g,%.0f,%.2g' %
                  (scene, 1e3 * duration, cpp, cpp * duration, python, python * duration), flush=True)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
"""client_calls.cpp in Python: a word in quotes is a text, True is itself. usage: client_calls.py TIMEOUT"""
import sys
from concurrent.futures import ThreadPoolExecutor

from afm_emulator import ending
import rospy
from afm_emulator import Client, EmulatorError
from afm_emulator.client import tau_between


def argument(word):
    if word in ('-', 'True'):
        return {'-': None, 'True': True}[word]
    return word.strip("'") if word.startswith("'") else float(word)


def control_in_threads(tip, *durations):
    """The lengths of 100 periods of each, that it got [us]."""
    def lengths(duration):
        periods = [tip.control(duration) for _ in range(100)]
        return {round(1e6 * tip.tau_s * tau_between(period.begin, period.end)) for period in periods}
    with ThreadPoolExecutor() as pool:
        return ' '.join(str(length) for found in pool.map(lengths, durations) for length in found)


others = []


def stale_reads(tip, commands):
    """Of what is in force, right after a command."""
    stale = 0
    for i in range(int(commands)):
        drag_velocity = 1e-6 * (1 + i % 2)
        tip.control(0.0, drag_velocity)
        stale += tip.applied.drag_velocity != drag_velocity
    return stale


def answer(tip, name, *words):
    if name == 'control_in_threads':
        return control_in_threads(tip, *map(argument, words))
    if name == 'tau':
        return '%g' % tip.tau_s
    if name == 'epoch':
        return '%d' % tip.configuration.epoch
    if name == 'in_force':
        return '%d' % tip.applied.number
    if name == 'another':
        others.append(Client('/afm'))
        return '%d' % others[-1].applied.number
    if name == 'stale_reads':
        return '%d' % stale_reads(tip, *map(argument, words))
    result = getattr(tip, name)(*map(argument, words))
    if name == 'control':
        end, begin = (time.tau + time.phase for time in (result.end, result.begin))
        return '%d %d %d %g %.9f %.9f %.9f' % (result.samples, result.applied, result.epoch, result.k_f_work, end,
                                               begin, 1e12 * result.mean_lateral_force)
    if name == 'command_and_wait':
        return '%d %g %g' % (result.number, result.drag_velocity, result.rest_height_m)
    return '%g' % result


def main():
    ending.init_node('client_calls', anonymous=True)
    tip = Client('/afm', float(sys.argv[1]))
    print('answer: there', flush=True)
    for line in sys.stdin:
        try:
            text = answer(tip, *line.split())
        except EmulatorError as fault:
            text = 'EmulatorError: %s' % fault
        print('answer: ' + text, flush=True)


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        print('answer: shut down', flush=True)

#!/usr/bin/python3
"""What samples cost that somebody wants, and what they cost while nobody does: starts a master and an emulator of its own,
subscribes to its deflection and leaves again by turns, and prints the share of a core of each thread of the emulator, the
median over the rounds, at the rates of the shipped scenes and at the highest.

usage: listener_cost.py [ROUNDS]"""
import os
import signal
import statistics
import subprocess
import sys
import time
import xmlrpc.client

import rospy

from record_throughput import free_port, threads

RATES = {'200 kHz of samples in 100 batches a second': {'sample_rate_hz': 2e5, 'batch_rate_hz': 100.0},
         '1 MHz in 1000': {'sample_rate_hz': 1e6, 'batch_rate_hz': 1000.0}}
ROUND_S = 3.0


def shares(pid):
    begin, before = time.monotonic(), threads(pid)
    time.sleep(ROUND_S)
    elapsed, now = time.monotonic() - begin, threads(pid)
    found = {name: 100 * (cpu - before.get(name, 0.0)) / elapsed for name, cpu in now.items()}
    return {'stepping': found['afm_step'], 'publishing': found['afm_publish'], 'all threads': sum(found.values())}


def measure(pid, rounds):
    found = {False: [], True: []}
    for _ in range(rounds):
        for listens in found:
            subscriber = rospy.Subscriber('/afm/deflection', rospy.AnyMsg, lambda _: None, tcp_nodelay=True) if listens else None
            time.sleep(0.5)  # for the connection, and what is still in its queue
            found[listens].append(shares(pid))
            if subscriber:
                subscriber.unregister()
    return found


def show(title, found):
    print(title)
    for listens, rounds in found.items():
        medians = ('%s %.1f' % (name, statistics.median(r[name] for r in rounds)) for name in rounds[0])
        print('  %-20s per cent of a core: %s' % ('somebody listens' if listens else 'nobody listens', ', '.join(medians)))


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % free_port()
    master = subprocess.Popen(['rosmaster', '--core', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]])
    binary = subprocess.check_output(['catkin_find', '--first-only', 'afm_emulator', 'emulator_node'], text=True).strip()
    try:
        server = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        while True:
            try:
                server.getPid('listener_cost')
                break
            except OSError:
                time.sleep(0.1)
        rospy.init_node('listener_cost', disable_signals=True)
        for title, rates in RATES.items():
            server.setParam('listener_cost', '/afm', rates)
            node = subprocess.Popen([binary, '__name:=afm'])
            time.sleep(2.0)
            show(title, measure(node.pid, rounds))
            node.send_signal(signal.SIGINT)
            node.wait()
    finally:
        master.kill()


if __name__ == '__main__':
    main()

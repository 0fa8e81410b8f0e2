#!/usr/bin/python3
"""Runs roslaunch as a user does who presses Ctrl-C once all is there: when every node that it names is known to the
master, or has ended well. Ends with 0 if roslaunch went on until then, and ended.

usage: until_interrupted.py roslaunch ARGUMENT...
"""
import os
import re
import signal
import subprocess
import sys
import threading
import time
import xmlrpc.client

PATIENCE = float(os.environ.get('AFM_PATIENCE', '1'))
DEADLINE_S = 90 * PATIENCE
STAYS_S = 1.0  # then: the first messages
ENDS_S = 30 * PATIENCE
MASTER = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])


class Launch:
    def __init__(self, command):
        self.text = ''
        # a session of its own: the signal is for it alone
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        universal_newlines=True, start_new_session=True)
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            self.text += line
            print(line, end='', flush=True)

    def names(self):
        """Of its nodes, in full, as it lists them: namespaces with their nodes."""
        listed = self.text.partition('\nNODES\n')[2].partition('\n\n')[0]
        spaces = re.findall(r'^  (/\S*)\n((?:    .*\n?)*)', listed, re.M)
        return [space.rstrip('/') + '/' + name for space, nodes in spaces
                for name in re.findall(r'^    (\S+) \(', nodes, re.M)]

    def is_up(self):
        names = self.names()
        return bool(names) and all(self.has_ended_well(name) or is_known(name) for name in names)

    def has_ended_well(self, name):
        return re.search(r'\[%s-\d+\] process has finished cleanly' % re.escape(name.lstrip('/')), self.text)

    def wait_until_up(self):
        end = time.monotonic() + DEADLINE_S
        while time.monotonic() < end and self.process.poll() is None and not self.is_up():
            time.sleep(0.1)
        time.sleep(STAYS_S)
        return self.is_up()

    def end(self):
        """Whether it could be interrupted, and ended."""
        was_running = self.process.poll() is None
        if was_running:
            os.killpg(self.process.pid, signal.SIGINT)
        try:
            self.process.wait(ENDS_S)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            return False
        self.reader.join(ENDS_S)
        return was_running


def is_known(name):
    try:
        return MASTER.lookupNode('until_interrupted', name)[0] == 1
    except OSError:
        return False


if __name__ == '__main__':
    launch = Launch(sys.argv[1:])
    is_up = launch.wait_until_up()
    if not launch.end():
        sys.exit('until_interrupted: it ended by itself, or would not end')
    if not is_up:
        sys.exit('until_interrupted: not within %g s: all of %s' % (DEADLINE_S, launch.names()))

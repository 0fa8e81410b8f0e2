"""Every Python node that we ship ends within 5 s of SIGINT, whenever that comes after the node's first lines. Before
them Python itself starts, and may swallow a SIGINT: it prints a KeyboardInterrupt and goes on. A node that imports
afm_emulator.ending later ends too, whichever of its threads gets the signal.

AFM_STOPS, 1 by default: so many rounds, in each of which all nodes start at once, and each is stopped at a random
moment.
"""
import functools
import itertools
import os
import random
import re
import signal
import time
from pathlib import Path

from emulator_under_test import Emulator, NodeTest, Process, find
from topics import Topic, wait_until

LONG = ('_for_s:=1e6', '_timeout_s:=1e6')
NODES = {'detector.py': (), 'hold_force.py': (), 'plot_force.py': (), 'seek_peak.py': (), 'live_status': (),
         'panel': (), 'expect': ('_field:=friction/force', '_least:=-1.0') + LONG, 'expect_sound': LONG}
ROUNDS = int(os.environ.get('AFM_STOPS', 1))
LATEST_S = 4.0  # after the first lines: by then all nodes run, on a slow machine too
LIMIT_S = 5.0
# a thread that was started before does not block the signal, as those that rospy starts by importing numpy; it prints
# its number, and the main thread waits for a lock
LATE = '''
import threading
early = threading.Thread(target=threading.Event().wait, daemon=True)
early.start()
import rospy
from afm_emulator import ending
print(early.native_id, flush=True)
lock = threading.Lock()
lock.acquire()
lock.acquire()
'''
# its children are not as deaf to signals as it is
PARENT = '''
from afm_emulator import ending
import multiprocessing
import subprocess
with multiprocessing.Pool(2) as pool:
    print(pool.map(abs, [-1, -2]), flush=True)
child = subprocess.Popen(['sleep', '1000'], preexec_fn=ending.unblock)
child.terminate()
print(child.wait(), flush=True)
'''


def blocks_sigint(process):
    """As its first lines do: a thread of its own waits for the signal."""
    with open('/proc/%d/status' % process.child.pid) as status:
        blocked = next(line for line in status if line.startswith('SigBlk:')).split()[1]
    return int(blocked, 16) & 1 << (signal.SIGINT - 1) != 0


class Ending(NodeTest):
    def test_the_controller_of_the_page_ends_without_a_traceback(self):
        page = Path(__file__).resolve().parents[2] / 'docs/controllers.md'
        code = re.search(r'```python\n(.*?)```', page.read_text(), re.S).group(1)
        for pace in ('lockstep', 'real_time'):
            emulator, applied = self.start(Emulator({'pace': pace})), Topic('applied')
            node = self.start(Process(['/usr/bin/python3', '-c', code]))
            applied.wait_for(lambda m: m.cause == 'rest_height', 'it commands')
            self.assertEqual(node.stop(), 0, pace)
            self.assertEqual(node.output(), '')
            applied.close()
            emulator.stop()

    def test_imported_after_rospy(self):
        """A signal that was ignored at the start too, as SIGINT is by the & of a script."""
        for number, action in (*itertools.product((signal.SIGINT, signal.SIGTERM), (signal.SIG_DFL, signal.SIG_IGN)),
                               (signal.SIGHUP, signal.SIG_DFL)):
            node = self.start(Process(['/usr/bin/python3', '-c', LATE],
                                      preexec_fn=functools.partial(signal.signal, number, action)))
            wait_until(lambda: node.output().endswith('\n'), 'it waits')
            os.kill(int(node.output()), number)  # the early thread gets it
            self.assertEqual(node.wait(LIMIT_S), 0)
            self.assertEqual(node.output().count('\n'), 1)

    def test_what_a_child_prints_is_whole_though_it_is_read_meanwhile(self):
        """It wrote at the beginning, where output() had gone to read."""
        child = self.start(Process(['/usr/bin/python3', '-c', 'for i in range(20000): print(i)']))
        while child.child.poll() is None:
            child.output()
        self.assertEqual(child.output(), ''.join('%d\n' % i for i in range(20000)))

    def test_children_end_when_they_are_asked_to(self):
        """The end of the pool hung for ever."""
        node = self.start(Process(['/usr/bin/python3', '-c', PARENT]))
        self.assertEqual(node.wait(60.0), 0)
        self.assertEqual(node.output(), '[1, 2]\n%d\n' % -signal.SIGTERM)

    def start_node(self, name):
        return self.start(Process([find(name), '__name:=' + name.split('.')[0], *NODES[name]],
                                  dict(os.environ, QT_QPA_PLATFORM='offscreen')))

    def test_at_any_moment(self):
        self.start(Emulator())
        chance = random.Random(43)
        for _ in range(ROUNDS):
            nodes = {name: self.start_node(name) for name in NODES}
            wait_until(lambda: all(blocks_sigint(node) for node in nodes.values()), 'the first lines of all have run')
            begin = time.monotonic()
            for moment, name in sorted((chance.uniform(0.0, LATEST_S), name) for name in NODES):
                time.sleep(max(0.0, begin + moment - time.monotonic()))
                asked = time.monotonic()
                nodes[name].child.send_signal(signal.SIGINT)
                code = nodes[name].wait(LIMIT_S)
                print('%s: ended with %d after %.1f s' % (name, code, time.monotonic() - asked))

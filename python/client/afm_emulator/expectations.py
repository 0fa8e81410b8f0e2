"""What the test nodes expect, expect_sound and expect_repeats share (docs/controllers.md)."""
import contextlib
import math
import os
import signal
import sys
import threading
import time
import unittest

import rosgraph.names
import rospy
import rostest
from afm_emulator.client import name_fault
from afm_emulator.msg import Configuration
from afm_emulator.subscription import Subscription

PACKAGE = 'afm_emulator'


class Test(unittest.TestCase):
    """Refuses private parameters that it does not know: a misspelt one would be left out of the test."""
    parameters = ()
    longMessage = False  # our sentences say all

    def setUp(self):
        own = rospy.get_name() + '/'
        given = [name[len(own):] for name in rospy.get_param_names() if name.startswith(own)]
        for name in sorted(given):
            self.assertIn(name.split('/')[0], self.parameters, 'parameter %s is unknown; there are: %s' %
                          (name, ', '.join(self.parameters)))


def parameter(name, default=None):
    """A private parameter. Without a default it must be given."""
    value = rospy.get_param('~' + name, default)
    if value is None:
        raise AssertionError('parameter %s is missing' % name)
    return value


def number(name, default=None):
    """A private parameter that is a number."""
    value = parameter(name, default)
    with contextlib.suppress(TypeError, ValueError):
        if not math.isnan(float(value)):
            return float(value)
    raise AssertionError('parameter %s = %r: must be a number' % (name, value))


def duration(name, default=None):
    """A private parameter that is a time above 0 [s]."""
    value = number(name, default)
    if not 0.0 < value < math.inf:
        raise AssertionError('parameter %s = %r: must be finite and above 0' % (name, value))
    return value


def time_after(name):
    """A private parameter that is a time, 0 or later [s]. Without one it is 0."""
    value = number(name, 0.0)
    if not 0.0 <= value < math.inf:
        raise AssertionError('parameter %s = %r: must be finite and not negative' % (name, value))
    return value


def how_long(timeout_s):
    """Why Follower.wait_for() gave up: a required node that dies ends the launch."""
    return 'when the launch ended' if rospy.is_shutdown() else 'after %g s of wall time' % timeout_s


def warn_of_late_begin(what, begin, end, after):
    """The emulator does not wait for a test that begins to listen."""
    rospy.logwarn('%s was judged from %g s to %g s of model time, not from after_s = %g on: the run was further when '
                  'this test began to listen', what, begin, end, after)


def flag(name, default):
    """A private parameter that is true or false."""
    value = parameter(name, default)
    if not isinstance(value, bool):
        raise AssertionError('parameter %s = %r: must be true or false' % (name, value))
    return value


def seconds_of(stamp, tau_s):
    """A ModelTime message in seconds of model time."""
    return (stamp.tau + stamp.phase) * tau_s


class Follower:
    """Follows a topic of the emulator until a condition on its messages holds or the wall clock says that it is
    enough. The messages are those of the latest epoch: after a reset it begins again. `earlier` has the last of each
    epoch before it. An emulator that is started anew fails the test; of a latched topic another one must tell, as what
    was published before comes after the latest message."""

    def __init__(self, topic, kind, is_latched=False):
        self.messages, self.earlier, self.news = [], [], threading.Condition()
        self.topic, self.is_latched, self.last, self.begins_anew = topic, is_latched, None, False
        self.subscription = Subscription(topic, kind, self._take, buff_size=1 << 22)

    def _take(self, message):
        with self.news:
            comes_again = self.last is not None and message.header.seq <= self.last.header.seq
            if comes_again and self.is_latched:
                return
            self.begins_anew |= comes_again
            self.last = message
            if self.messages and message.epoch != self.messages[-1].epoch:
                self.earlier.append(self.messages[-1])
                self.messages.clear()
            self.messages.append(message)
            self.news.notify_all()

    def check(self):
        if self.begins_anew:
            raise AssertionError('%s: the emulator was started again while it was tested' % self.topic)

    def wait_for(self, condition, timeout_s):
        """Whether it came true of the messages so far in that time, and these."""
        end = time.monotonic() + timeout_s
        while True:
            with self.news:
                self.check()
                came_true = bool(condition(self.messages))
                if came_true or time.monotonic() > end or rospy.is_shutdown():
                    return came_true, list(self.messages)
                self.news.wait(0.1)
            self.subscription.ask_again()


def configuration_of(emulator, timeout_s):
    """The emulator's Configuration, once it is there."""
    follower = Follower(emulator + '/configuration', Configuration, is_latched=True)
    _, messages = follower.wait_for(bool, timeout_s)
    follower.subscription.close()
    if not messages:
        raise AssertionError('%s/configuration: %s nothing had come: no emulator there?' %
                             (emulator, how_long(timeout_s)))
    return messages[-1]


def results_path(name):
    """Where the results of the test go, for a file beside them."""
    for argument in sys.argv:
        if argument.startswith('--gtest_output=xml:'):
            directory = os.path.dirname(argument[len('--gtest_output=xml:'):])
            os.makedirs(directory, exist_ok=True)
            return os.path.join(directory, name)
    return os.path.abspath(name)


def draw(path, title, label, points, least, most, window):
    """A picture of the signal, (time, value), and of what was expected of it."""
    import matplotlib
    matplotlib.use('Agg')
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 5), constrained_layout=True)
    axes.plot([time for time, _ in points], [value for _, value in points], color='#0072B2', lw=1)
    axes.axvspan(*window, color='#999999', alpha=0.2, lw=0)
    for bound in (least, most):
        if math.isfinite(bound):
            axes.axhline(bound, color='#D55E00', ls='--', lw=1)
    axes.set(xlabel='model time [s]', ylabel=label, title=title)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def run(name, case):
    """Runs a test case as a node of this name under rostest; with --help prints what it is."""
    if '--help' in sys.argv or '-h' in sys.argv:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # it may be read by head
        print(sys.modules['__main__'].__doc__ + '\n--help: this text')
        return
    from afm_emulator import ending  # of a node alone: children of a test that blocks signals would not end
    ending.LEAVE_S = 2  # to write the result
    ending.init_node(name, anonymous=True)
    rostest.rosrun(PACKAGE, name, case, sys.argv)


def emulator_name():
    """What the private parameter `emulator` names."""
    name = parameter('emulator', 'afm')
    fault = name_fault(name)
    if fault:
        raise AssertionError('parameter emulator = %r: %s' % (name, fault))
    return rosgraph.names.ns_join('/', rospy.resolve_name(name))

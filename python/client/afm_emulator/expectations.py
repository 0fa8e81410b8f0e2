"""What the test nodes expect, expect_sound and expect_repeats share (docs/controllers.md)."""
import math
import os
import sys
import threading
import time

import rosgraph.names
import rospy
import rostopic
import rostest

PACKAGE = 'afm_emulator'


def parameter(name, default=None):
    """A private parameter. Without a default it must be given."""
    value = rospy.get_param('~' + name, default)
    if value is None:
        raise ValueError('parameter %s is missing' % name)
    return value


def seconds_of(stamp, tau_s):
    """A ModelTime message in seconds of model time."""
    return (stamp.tau + stamp.phase) * tau_s


class Follower:
    """Follows a topic of the emulator until a condition on its messages holds or the wall clock says that it is
    enough."""

    def __init__(self, topic, kind):
        self.messages, self.news = [], threading.Condition()
        rospy.Subscriber(topic, kind, self._take, tcp_nodelay=True, buff_size=1 << 22)

    def _take(self, message):
        with self.news:
            self.messages.append(message)
            self.news.notify_all()

    def wait_for(self, condition, timeout_s):
        """Whether it came true of the messages so far in that time."""
        end = time.monotonic() + timeout_s
        with self.news:
            while not condition(self.messages):
                if time.monotonic() > end or rospy.is_shutdown():
                    return False
                self.news.wait(0.1)
        return True


def message_class(topic, timeout_s):
    """Of a topic that is advertised within that time."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end and not rospy.is_shutdown():
        kind, _, _ = rostopic.get_topic_class(topic)
        if kind is not None:
            return kind
        time.sleep(0.1)
    raise AssertionError('%s: nobody has published it within %g s' % (topic, timeout_s))


def results_path(name):
    """Where the results of the test go, for a file beside them."""
    for argument in sys.argv:
        if argument.startswith('--gtest_output=xml:'):
            directory = os.path.dirname(argument[len('--gtest_output=xml:'):])
            os.makedirs(directory, exist_ok=True)
            return os.path.join(directory, name)
    return os.path.abspath(name)


def draw(path, title, label, times, values, least, most, window):
    """A picture of the signal and of what was expected of it."""
    import matplotlib
    matplotlib.use('Agg')
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 5), constrained_layout=True)
    axes.plot(times, values, color='#0072B2', lw=1)
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
        print(sys.modules['__main__'].__doc__ + '\n--help: this text')
        return
    rospy.init_node(name, anonymous=True)
    rostest.rosrun(PACKAGE, name, case, sys.argv)


def emulator_name():
    return rosgraph.names.ns_join('/', rospy.resolve_name(rospy.get_param('~emulator', 'afm')))

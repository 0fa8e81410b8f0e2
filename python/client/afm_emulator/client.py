"""What a controller needs: commands that wait until they hold, and what is measured over a control period.

In lockstep (parameter pace) the emulator advances one period at a time and waits for the controller: the same
controller gives the same bits each time. In real time the same calls measure while the clock goes on. The controller
need not know which it is.
"""
import collections
import math
import threading
import time

import rosgraph.names
import rospy
from afm_emulator.connection import Connection
from afm_emulator.msg import Applied, Configuration
from afm_emulator.srv import Control, ControlRequest

KEPT_APPLIED = 1000
MOST_TAU = 9999.0  # of a period of mean_force in lockstep: the emulator takes 10000, rounding aside
LONGEST_S = 1e9
PATIENCE = 3.0  # times the period, in real time


class EmulatorError(RuntimeError):
    """What did not come in time, or why the emulator refused."""


def finite(name, value, wanted='a finite number'):
    """The value as a float. An EmulatorError names an argument that is no finite number."""
    try:
        number = math.nan if isinstance(value, (str, bytes, bool)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise EmulatorError('%s = %r: must be %s' % (name, value, wanted))
    return number


def commanded(name, value):
    """What a request commands: nan leaves it as it is."""
    return math.nan if value is None else finite(name, value, 'a finite number, or None: as it is')


def not_negative(name, value):
    number = finite(name, value)
    if number < 0.0:
        raise EmulatorError('%s = %r: must not be negative' % (name, value))
    return number


def number_parameter(name, usual):
    """A private parameter of this node, as a float. An EmulatorError names one that is no number, such as 60e-12, which
    is a text in YAML."""
    return finite(rospy.resolve_name('~' + name), rospy.get_param('~' + name, usual),
                  'a number; YAML needs 1.0e-12 for 1e-12')


def name_fault(name):
    """Why no node can have this name, or nothing: who waits for one would wait in vain."""
    if isinstance(name, str) and name.strip('/') and rosgraph.names.is_legal_name(name):
        return ''
    return 'must be the name of a node: letters, digits, _ and /, of which a letter, / or ~ comes first'


def tau_between(begin, end):
    """Model time from one ModelTime message to another [tau]."""
    return (end.tau - begin.tau) + (end.phase - begin.phase)


class Client:
    """An emulator, by the name of its node. The same calls work in real time and in lockstep.

    name: of the node, such as 'afm', resolved as that of a topic is; an EmulatorError if no node can have it
    timeout: wall time that every call waits for an answer before it raises an EmulatorError [s], in real time longer by
        three times the period. The default is longer than the 12 s after which the emulator itself answers that a
        control period in lockstep takes too long.

    `configuration` is the latest message of that topic, there from the beginning. Every call raises a
    rospy.ROSInterruptException when this node is shut down, by Ctrl-C or its launch file. Calls from several threads,
    such as callbacks of rospy, take turns. `applied` and command_and_wait() are not for a callback of the topics
    applied and configuration: they wait for messages that come after it.
    """

    def __init__(self, name='afm', timeout=15.0):
        if not rospy.core.is_initialized():
            raise EmulatorError('rospy.init_node comes before a Client')
        fault = name_fault(name)
        if fault:
            raise EmulatorError('name = %r: %s' % (name, fault))
        self.name = rospy.resolve_name(name)
        self.timeout = not_negative('timeout', timeout)
        if self.timeout > LONGEST_S:
            raise EmulatorError('timeout = %r: must be at most %g s' % (timeout, LONGEST_S))
        self.configuration = None
        self._applied = None  # the latest message
        self._reported = (0, 0)   # epoch and number of what was in force at the end of the latest answer
        self._turn = threading.RLock()  # of the call under way
        self._news = threading.Condition()
        self._commanded = collections.deque(maxlen=KEPT_APPLIED)  # Applied messages since the latest command
        self._subscribers, self._heard = [], set()
        self._connection = None    # to ~control
        self._call_control()

    @property
    def applied(self):
        """What is in force: the latest message, none older than what held at the end of the latest `control`."""
        return self._wait_for(lambda: (self._applied.epoch, self._applied.number) >= self._reported and self._applied,
                              self.name + '/applied')

    @property
    def is_lockstep(self):
        """Whether the emulator waits for `control`, instead of for the wall clock."""
        return self.configuration.pace == 'lockstep'

    @property
    def tau_s(self):
        """Seconds of model time in a tau."""
        return 2.0 * math.pi / self.configuration.omega_v_rad_per_s

    @property
    def lateral_stiffness(self):
        """Stiffness of the horizontal spring [N/m]."""
        return self.configuration.tip_mass_kg * self.configuration.omega_h_rad_per_s ** 2

    @property
    def stiffness(self):
        """Stiffness of the vertical spring [N/m]."""
        return self.configuration.tip_mass_kg * self.configuration.omega_v_rad_per_s ** 2

    def control(self, duration, drag_velocity=None, rest_height=None):
        """Commands what is given, advances, and returns what was measured on the way: the answer of the service
        ~control.

        duration: of the control period [s of model time]; in lockstep at most 10000 tau; in real time rounded up to
            whole batches
        drag_velocity: [m/s]; None: as it is
        rest_height: height of the holder above mid-surface [m]; None: as it is

        Raises an EmulatorError if the emulator refuses, or does not answer within the timeout. Whenever a call fails,
        the next one makes a new connection, to an emulator that was restarted too.
        """
        request = ControlRequest(duration=not_negative('duration', duration),
                                 drag_velocity=commanded('drag_velocity', drag_velocity),
                                 rest_height=commanded('rest_height', rest_height))
        with self._turn:
            answer = self._call_control(request)
            if not answer.success:
                if 'shutting down' in answer.message:
                    self._end_with_the_launch()
                raise EmulatorError('%s/control: %s' % (self.name, answer.message))
            self._reported = answer.epoch, answer.applied
        return answer

    def command_and_wait(self, drag_velocity=None, rest_height=None):
        """Commands what is given and waits until it holds. Returns the Applied message of the command, from which on it
        does; without a command what is in force.

        drag_velocity: [m/s]; None: as it is
        rest_height: height of the holder above mid-surface [m]; None: as it is
        """
        with self._turn:
            with self._news:
                self._commanded.clear()
            answer = self.control(0.0, drag_velocity, rest_height)
            if drag_velocity is None and rest_height is None:
                return self.applied
            return self._wait_for(lambda: next((m for m in self._commanded if (m.epoch, m.number) ==
                                                (answer.epoch, answer.applied)), None), self.name + '/applied')

    def mean_force(self, duration, settle=0.0, drag_velocity=None, rest_height=None):
        """Mean force of the holder on the tip along +x [N].

        duration: over which the force is averaged [s of model time]
        settle: time from when the command holds to the beginning of the average [s of model time]
        drag_velocity: [m/s]; None: as it is
        rest_height: height of the holder above mid-surface [m]; None: as it is

        Longer times than a control period can have in lockstep take several periods. An EmulatorError if anything else
        is commanded or changed on the way, also by others.
        """
        duration, settle = not_negative('duration', duration), not_negative('settle', settle)
        tau, mean = 0.0, 0.0
        with self._turn:
            last = self.control(0.0, drag_velocity, rest_height)
            for last in self._undisturbed(last, settle):
                pass
            for last in self._undisturbed(last, duration):
                more = tau_between(last.begin, last.end)
                if more > 0.0:
                    tau += more
                    mean += more / tau * (last.mean_lateral_force - mean)
        if tau == 0.0:
            raise EmulatorError('duration = %g s: too short, no time passes in it' % duration)
        return mean

    def _undisturbed(self, last, duration):
        """The answers of control periods that follow `last`, in which what holds at its end goes on to hold."""
        count = math.ceil(duration / (MOST_TAU * self.tau_s)) if self.is_lockstep else 1
        for _ in range(count if duration > 0.0 else 0):
            answer = self.control(duration / count)
            if answer.epoch != last.epoch:
                raise EmulatorError('%s: reset while it was measured' % self.name)
            if answer.applied != last.applied:
                raise EmulatorError('%s: another command or change took effect while it was measured' % self.name)
            if self.is_lockstep and tau_between(last.end, answer.begin) != 0.0:
                raise EmulatorError('%s: another controller advanced it while it was measured' % self.name)
            last = answer
            yield answer

    def _call_control(self, request=None):
        """The answer of ~control. Connects to it if need be; without a request, it only connects."""
        service, seconds = rospy.resolve_name(self.name + '/control'), self.timeout
        try:
            if self._connection is None:
                self._connection = Connection(service, Control, time.monotonic() + seconds)
                self._subscribe()
            if request is None:
                return None
            if not self.is_lockstep:  # it may fall behind, or be paused
                seconds = min(seconds + PATIENCE * request.duration / self.configuration.time_scale, LONGEST_S)
            return self._connection.call(request, time.monotonic() + seconds)
        except BaseException as fault:
            what = 'was not there' if self._connection is None else 'may still come to it, but did not answer'
            self._drop_connection()  # half a request or half an answer may be on it
            if isinstance(fault, TimeoutError):
                raise EmulatorError('%s: %s within %g s (%s)' % (service, what, seconds, fault)) from fault
            if isinstance(fault, OSError):
                self._end_with_the_launch()
                raise EmulatorError('%s: %s: was the emulator restarted? The next call connects again'
                                    % (service, fault)) from fault
            raise

    def _subscribe(self):
        """Anew for every connection: the latched messages are then those of the emulator that runs now."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._heard, self._reported = set(), (0, 0)
        self._subscribers = [rospy.Subscriber('%s/%s' % (self.name, topic), kind, keep, tcp_nodelay=True)
                             for topic, kind, keep in (('configuration', Configuration, self._keep_configuration),
                                                       ('applied', Applied, self._keep_applied))]
        for topic in ('configuration', 'applied'):
            self._wait_for(lambda: topic in self._heard, '%s/%s' % (self.name, topic))

    def _drop_connection(self):
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    @staticmethod
    def _end_with_the_launch():
        """roslaunch ends its nodes one after another: if the emulator has gone first, our turn comes soon."""
        end = time.monotonic() + 1.0
        while time.monotonic() < end:
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException('shut down')
            time.sleep(0.02)

    def _keep_configuration(self, message):
        with self._news:
            if self.configuration is not None and message.epoch <= self.configuration.epoch:
                self._reported = (0, 0)  # it is of an emulator that was started anew
            self.configuration = message
            self._heard.add('configuration')
            self._news.notify_all()

    def _keep_applied(self, message):
        with self._news:
            # rospy may give a new subscription what is latched after what has come since
            if 'applied' in self._heard and (message.header.seq < self._applied.header.seq and
                                             message.header.stamp <= self._applied.header.stamp):
                return
            self._applied = message
            self._heard.add('applied')
            self._commanded.append(message)
            self._news.notify_all()

    def _wait_for(self, condition, what):
        """What the condition returns as soon as that is true."""
        end = time.monotonic() + self.timeout
        with self._news:
            while True:
                found = condition()
                if found:
                    return found
                if rospy.is_shutdown():
                    raise rospy.ROSInterruptException('shut down')
                if time.monotonic() > end:
                    raise EmulatorError('%s: nothing came within %g s' % (what, self.timeout))
                self._news.wait(0.05)

"""What a controller needs: commands that wait until they hold, and what is measured over a control period.

In lockstep (parameter pace) the emulator advances one period at a time and waits for the controller: the same
controller gives the same bits each time. In real time the same calls measure while the clock goes on. The controller
need not know which it is.
"""
import collections
import itertools
import math
import threading
import time

import rospy
from afm_emulator.connection import Connection
from afm_emulator.impacts import sequence_number
from afm_emulator.measurement import Measurement, tau_between
from afm_emulator.msg import Applied, Configuration, Deflection
from afm_emulator.srv import Control, ControlRequest
from std_msgs.msg import Float64

AGAIN_S = 1.0  # of wall time: a command without effect is published again, as the emulator may have been restarted
QUEUE_BYTES = 1 << 22
KEPT_APPLIED = 1000
KEPT_BATCHES = 100  # before a measurement: a second at the default rate
MOST_TAU = 9999.0  # of a period of mean_force in lockstep: the emulator takes 10000, rounding aside
LONGEST_TIMEOUT_S = 1e9
MOST_DOWN = 1e5  # lattice spacings: kMinRestHeight of the core
PAUSED = ' (is the emulator paused? What was commanded may hold)'
ROUNDING = 1e-9  # of a sum of batches: ten of 0.01 s are 0.1 s


class EmulatorError(RuntimeError):
    """What did not come in time, or why the emulator refused."""


def finite(name, value, wanted='a finite number'):
    """The value as a float. An EmulatorError names an argument that is no finite number."""
    try:
        number = math.nan if isinstance(value, (str, bytes)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise EmulatorError('%s = %r: must be %s' % (name, value, wanted))
    return number


def finite_or_none(name, value):
    return None if value is None else finite(name, value, 'a finite number, or None: as it is')


def not_negative(name, value):
    number = finite(name, value)
    if number < 0.0:
        raise EmulatorError('%s = %r: must not be negative' % (name, value))
    return number


class Client:
    """An emulator, by the name of its node. The same calls work in real time and in lockstep.

    name: of the node, such as 'afm'
    timeout: wall time that every call waits for an answer before it raises an EmulatorError [s]. The default is longer
        than the 12 s after which the emulator itself answers that a control period takes too long.

    `configuration` and `applied` are the latest messages of these topics. They are there from the beginning. Every call
    raises a rospy.ROSInterruptException when this node is shut down, by Ctrl-C or its launch file. Calls from several
    threads, such as callbacks of rospy, take turns.
    """

    def __init__(self, name='afm', timeout=15.0):
        self.name = rospy.resolve_name(name)
        self.timeout = not_negative('timeout', timeout)
        if self.timeout > LONGEST_TIMEOUT_S:
            raise EmulatorError('timeout = %r: must be at most %g s' % (timeout, LONGEST_TIMEOUT_S))
        self.configuration = None  # the latest message
        self.applied = None        # the latest message: what is in force
        self._connections = {}     # topic: (header of its latest connection, number of connections)
        self._starts = self._starts_told = 1  # of the emulator, since this client was made; those that a call has told
        self._turn = threading.RLock()  # of the call under way
        self._news = threading.Condition()
        self._commanded = collections.deque(maxlen=KEPT_APPLIED)  # Applied messages since the latest command
        self._batches = None       # Deflection messages, while something is measured
        # (sequence number, bytes) of what comes beside Deflection: that of a batch may come before it
        self._beside = {'impacts': [], 'friction': []}
        self._publishers = {topic: rospy.Publisher('%s/%s' % (self.name, topic), Float64, queue_size=10,
                                                   tcp_nodelay=True)
                            for topic in ('drag_velocity', 'rest_height')}
        for topic, kind in (('configuration', Configuration), ('applied', Applied)):
            rospy.Subscriber('%s/%s' % (self.name, topic), kind, self._keep, topic, tcp_nodelay=True)
        self._connection = None    # to ~control, in lockstep
        for topic in ('configuration', 'applied'):
            self._wait_for(lambda: getattr(self, topic) is not None, '%s/%s' % (self.name, topic))
        if self.is_lockstep:
            self._call_control()  # its service is advertised after the topics
            return  # the answers of the service hold what is measured
        options = dict(tcp_nodelay=True, buff_size=QUEUE_BYTES)
        measured = [rospy.Subscriber(self.name + '/deflection', Deflection, self._take_batch, **options)]
        measured += [rospy.Subscriber('%s/%s' % (self.name, topic), rospy.AnyMsg, self._take_beside, topic, **options)
                     for topic in self._beside]
        for subscriber in measured:  # batches of one topic without those of the other would count
            self._wait_for(lambda: subscriber.get_num_connections() > 0, subscriber.resolved_name)

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
        duration = not_negative('duration', duration)
        drag_velocity = finite_or_none('drag_velocity', drag_velocity)
        rest_height = finite_or_none('rest_height', rest_height)
        with self._turn:
            if not self.is_lockstep:
                self._check_restart()
                return self._measure(self.command_and_wait(drag_velocity, rest_height), duration)
            answer = self._call_control(ControlRequest(math.nan if drag_velocity is None else drag_velocity,
                                                       math.nan if rest_height is None else rest_height, duration))
        if not answer.success:
            raise EmulatorError('%s/control: %s' % (self.name, answer.message))
        return answer

    def command_and_wait(self, drag_velocity=None, rest_height=None):
        """Commands what is given and waits until it holds. Returns the Applied message of the command, from which on it
        does; without a command the latest one.

        drag_velocity: [m/s]; None: as it is
        rest_height: height of the holder above mid-surface [m]; None: as it is
        """
        drag_velocity = finite_or_none('drag_velocity', drag_velocity)
        rest_height = finite_or_none('rest_height', rest_height)
        if drag_velocity is None and rest_height is None:
            return self.applied
        most = self.configuration.max_drag_velocity
        if drag_velocity is not None and abs(drag_velocity) > most:  # in real time nothing would come back
            raise EmulatorError('drag_velocity = %g m/s: max_drag_velocity is %g' % (drag_velocity, most))
        crest, deepest = self.configuration.surface_amplitude_m, -MOST_DOWN * self.configuration.lattice_spacing_m
        if rest_height is not None and not deepest <= rest_height < crest:
            raise EmulatorError('rest_height = %g m: must be below the crests of the surface, %g m, and at most %g '
                                'lattice spacings down' % (rest_height, crest, MOST_DOWN))
        with self._turn:
            if self.is_lockstep:
                self._forget_commanded()
                answer = self.control(0.0, drag_velocity, rest_height)
                return self._wait_for(lambda: next((m for m in self._commanded if (m.epoch, m.number) ==
                                                    (answer.epoch, answer.applied)), None), self.name + '/applied')
            self._check_restart()
            applied = []
            for topic, field, value in (('drag_velocity', 'drag_velocity', drag_velocity),
                                        ('rest_height', 'rest_height_m', rest_height)):
                if value is not None:
                    applied.append(self._command(topic, field, value))
            self._check_restart()
            if applied[0].epoch != applied[-1].epoch:
                raise EmulatorError('%s: reset between two commands' % self.name)
            return applied[-1]

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
            settling = self._periods(settle)
            answers = self._undisturbed(settling + self._periods(duration), drag_velocity, rest_height)
            for answer in itertools.islice(answers, len(settling), None):
                more = tau_between(answer.begin, answer.end)
                if more > 0.0:
                    tau += more
                    mean += more / tau * (answer.mean_lateral_force - mean)
        if tau == 0.0:
            raise EmulatorError('duration = %g s: too short, no time passes in it' % duration)
        return mean

    def _periods(self, duration):
        """Control periods of equal length [s]."""
        count = max(1, math.ceil(duration / (MOST_TAU * self.tau_s))) if self.is_lockstep else 1
        return [duration / count] * count if duration > 0.0 else []

    def _undisturbed(self, periods, drag_velocity, rest_height):
        """The answers of control periods that follow each other, in which what is commanded holds."""
        if self.is_lockstep:
            command = self.control(0.0, drag_velocity, rest_height)
            number, end = command.applied, command.end
        else:
            command = self.command_and_wait(drag_velocity, rest_height)
            number, end = command.number, None
        for period in periods:
            answer = self.control(period)
            if answer.epoch != command.epoch:
                raise EmulatorError('%s: reset while it was measured' % self.name)
            if answer.applied != number and (self.is_lockstep or not self._was_sent_again(command, answer.applied)):
                raise EmulatorError('%s: another command or change took effect while it was measured' % self.name)
            if end and tau_between(end, answer.begin) != 0.0:
                raise EmulatorError('%s: another controller advanced it while it was measured' % self.name)
            end = end and answer.end
            yield answer

    def _was_sent_again(self, command, number):
        """Whether what took effect since then is the same command: it is sent again to an emulator that is slow."""
        with self._news:
            return all(m.cause in self._publishers and (m.drag_velocity, m.rest_height_m) ==
                       (command.drag_velocity, command.rest_height_m)
                       for m in self._commanded if command.number < m.number <= number)

    def _call_control(self, request=None):
        """The answer of ~control. Connects to it if need be; without a request, it only connects."""
        end, service = time.monotonic() + self.timeout, self.name + '/control'
        try:
            if self._connection is None:
                self._connection = Connection(service, Control, end)
            return self._connection.call(request, end) if request else None
        except BaseException as fault:
            what = 'was not there' if self._connection is None else 'may still come to it, but did not answer'
            self._drop_connection()  # half a request or half an answer may be on it
            if isinstance(fault, TimeoutError):
                raise EmulatorError('%s: %s within %g s (%s)' % (service, what, self.timeout, fault)) from fault
            if isinstance(fault, OSError):
                self._end_with_the_launch()
                raise EmulatorError('%s: %s: was the emulator restarted? The next call connects again'
                                    % (service, fault)) from fault
            raise

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

    def _note_connection(self, topic, message):
        """A new connection is to a new start of the emulator. Each topic meets it at its own time."""
        header, count = self._connections.get(topic, (None, 0))
        if message._connection_header is header:
            return
        self._connections[topic] = message._connection_header, count + 1
        for kept in self._beside:
            if topic == kept or count + 1 > self._starts:
                self._beside[kept].clear()
        self._starts = max(self._starts, count + 1)

    def _keep(self, message, topic):
        with self._news:
            self._note_connection(topic, message)
            setattr(self, topic, message)
            if topic == 'applied':
                self._commanded.append(message)
            self._news.notify_all()

    def _take_batch(self, message):
        with self._news:
            self._note_connection('deflection', message)
            if self._batches is not None:
                self._batches.append(message)
            self._news.notify_all()

    def _take_beside(self, message, topic):
        """As bytes: thousands of impacts a batch would take a processor to unpack."""
        with self._news:
            self._note_connection(topic, message)
            kept = self._beside[topic]
            kept.append((sequence_number(message._buff), message._buff))
            if self._batches is None:
                del kept[:-KEPT_BATCHES]
            self._news.notify_all()

    def _wait_for(self, condition, what, seconds=None, may_fail=False):
        """What the condition returns as soon as that is true."""
        seconds = self.timeout if seconds is None else seconds
        end = time.monotonic() + seconds
        with self._news:
            while True:
                found = condition()
                if found:
                    return found
                if rospy.is_shutdown():
                    raise rospy.ROSInterruptException('shut down')
                if time.monotonic() > end:
                    if may_fail:
                        return None
                    raise EmulatorError('%s: nothing came within %g s' % (what, seconds))
                self._news.wait(0.05)

    def _forget_commanded(self):
        with self._news:
            self._commanded.clear()

    def _command(self, topic, field, value):
        end = time.monotonic() + self.timeout
        self._wait_for(lambda: self._publishers[topic].get_num_connections() > 0, '', may_fail=True)
        self._forget_commanded()
        while True:
            self._publish(topic, value)
            # the emulator reports every command, also one of the value that holds already
            applied = self._wait_for(lambda: next((m for m in self._commanded if getattr(m, field) == value), None), '',
                                     min(AGAIN_S, max(0.0, end - time.monotonic())), True)
            if applied:
                return applied
            if time.monotonic() > end:
                raise EmulatorError('%s/%s: %g had no effect within %g s: refused, or no emulator there?'
                                    % (self.name, topic, value, self.timeout))

    def _publish(self, topic, value):
        try:
            self._publishers[topic].publish(value)
        except rospy.ROSException as fault:  # its topics are closed
            raise rospy.ROSInterruptException('shut down') from fault

    def _next_batch(self, seconds):
        self._wait_for(lambda: self._batches, self.name + '/deflection' + PAUSED, seconds)
        with self._news:
            return self._batches.pop(0)

    def _check_restart(self):
        with self._news:
            told, self._starts_told = self._starts_told, self._starts
        if told < self._starts_told:
            raise EmulatorError('%s: it was restarted, and its state is lost' % self.name)

    def _measure(self, applied, duration):
        """As the emulator measures in lockstep, from the batches that it publishes."""
        with self._news:
            self._batches = []
            for kept in self._beside.values():
                del kept[:-KEPT_BATCHES]
        try:
            for topic, kept in self._beside.items():  # of a new connection, after a restart
                self._wait_for(lambda: kept, '%s/%s%s' % (self.name, topic, PAUSED))
            return self._measured(applied, duration)
        finally:
            with self._news:
                self._batches = None

    def _drain(self, measurement):
        """What came beside its batches, but for the latest: a long period would fill the memory."""
        for topic, add in measurement.adders():
            with self._news:
                kept = self._beside[topic]
                count = sum(1 for number, _ in kept[:-1] if number <= measurement.last)
                of_batches, kept[:count] = kept[:count], []
            add(of_batches)

    def _measured(self, applied, duration):
        measurement, expected = Measurement(applied, self), None
        while measurement.seconds < duration * (1.0 - ROUNDING):
            batch = self._next_batch(self.timeout + duration / self.configuration.time_scale)
            self._check_restart()
            if batch.epoch > applied.epoch:
                raise EmulatorError('%s: reset while it was measured' % self.name)
            if batch.epoch < applied.epoch:
                continue
            if expected not in (None, batch.first_sample):
                raise EmulatorError('%s/deflection: messages were lost while it was measured' % self.name)
            expected = batch.first_sample + len(batch.vertical)
            with self._news:  # nothing: of a restart, which the next batch says
                whole = measurement.last is not None or all(kept and batch.header.seq >= kept[0][0]
                                                            for kept in self._beside.values())
            if whole and tau_between(applied.time, batch.time) >= 0.0:
                measurement.add(batch)
                if batch.header.seq % 10 == 0:  # a Friction message is slow to unpack
                    self._drain(measurement)
        for topic, add in measurement.adders():
            kept, name = self._beside[topic], '%s/%s' % (self.name, topic)
            if measurement.last is not None:  # it comes on a connection of its own
                self._wait_for(lambda: kept and kept[-1][0] >= measurement.last, name)
            with self._news:
                lost = add(kept)
            if lost:
                raise EmulatorError('%s: %d messages were lost while it was measured' % (name, lost))
        with self._news:
            applied = list(self._commanded)
        return measurement.answer(applied)

"""The emulator on its topics and services, live or replayed. Callbacks only put aside what comes; the window takes it
30 times a second."""
import collections
import contextlib
import math
import queue
import threading
import time

import rospy
from afm_emulator.msg import Applied, Configuration, Deflection, EmulatorStatus, Friction, ImpactArray
from afm_emulator.srv import StartRecording, Step
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from ..connection import Connection
from ..impacts import read_impacts
from ..subscription import ASK_AGAIN_S, Subscription

PAIRING_S = 0.1       # that a batch waits for its impacts, which come on another topic
SERVICE_S = 5.0       # that a service is waited for
ANSWER_S = 35.0       # and then its answer: a step may take 8 s, and closing a bag half a minute
WAITING_BATCHES = 200
LATEST = {'configuration': Configuration, 'applied': Applied, 'friction': Friction, 'status': EmulatorStatus}
NumpyDeflection = numpy_msg(Deflection)


def read_seq(data):
    """Of the header that a message begins with."""
    return int.from_bytes(data[:4], 'little')


class Link:
    def __init__(self, name):
        self.name = name
        self._raw, self._decoded = {}, {}  # by topic of LATEST
        self.run = 0  # another number for each epoch and each emulator
        self.diagnostics = {}           # status by its name
        self.notes = collections.deque(maxlen=1)  # what a service answered, for the operator
        self._batches, self._impacts, self._applied = (collections.deque(maxlen=WAITING_BATCHES) for _ in range(3))
        self._heard = -math.inf
        self._jobs, self._wanted = queue.Queue(), {}
        self._lock = threading.Lock()
        self._commands, self._is_closed = {}, False
        self._advertise()
        kinds = dict(LATEST, deflection=Deflection, impacts=ImpactArray)
        self._subscriptions = [Subscription('/diagnostics', DiagnosticArray, self._keep_diagnostics)]
        self._subscriptions += [Subscription('%s/%s' % (name, topic), rospy.AnyMsg, self._keep, (topic, kind),
                                             buff_size=1 << 20) for topic, kind in kinds.items()]
        threading.Thread(target=self._work, daemon=True).start()

    # what comes

    def close(self):
        self._jobs.put(None)
        for subscription in self._subscriptions:
            subscription.close()
        with self._lock:
            self._is_closed = True
            for publisher in self._commands.values():
                publisher.unregister()

    def silence(self):
        """Seconds of wall time since anything came. Asks again for what is not connected."""
        for subscription in self._subscriptions:
            subscription.ask_again()
        if time.monotonic() > self._advertised + ASK_AGAIN_S and not self.takes_commands():
            self._advertised = math.inf
            threading.Thread(target=self._advertise, daemon=True).start()  # a master that is gone lets one wait
        return time.monotonic() - self._heard

    def latest(self, topic):
        """The newest message, decoded now, or None."""
        raw = self._raw.get(topic)
        if raw is not None and self._decoded.get(topic, (None,))[0] is not raw:
            self._decoded[topic] = raw, LATEST[topic]().deserialize(raw)
        return self._decoded[topic][1] if raw is not None else None

    def takes_commands(self):
        """Else it is a recording that is played."""
        try:
            return all(publisher.get_num_connections() > 0 for publisher in self._commands.values())
        except AttributeError:  # it is just advertised anew
            return False

    def batches(self):
        """(Deflection message, its impacts as (epoch, table)) of every batch since the last call; without impacts if
        they did not come in time."""
        while self._batches:
            arrived, batch = self._batches[0]
            waiting = self._impacts  # another thread may replace it
            have_come = waiting and waiting[-1][0] >= batch.header.seq
            if not have_come and time.monotonic() - arrived < PAIRING_S:
                return
            self._batches.popleft()
            impacts = []
            while waiting and waiting[0][0] <= batch.header.seq:
                impacts.append(waiting.popleft()[1:])
            yield batch, impacts

    def changes(self):
        """Every Applied since the last call."""
        while self._applied:
            yield self._applied.popleft()

    def _advertise(self):
        """Anew while nobody is connected: a master that comes back knows no publisher."""
        with self._lock:
            for topic in ('drag_velocity', 'rest_height') if not self._is_closed else ():
                former = self._commands.get(topic)
                if former is None or former.get_num_connections() == 0:
                    if former is not None:
                        former.unregister()
                    self._commands[topic] = rospy.Publisher('%s/%s' % (self.name, topic), Float64, queue_size=10,
                                                            tcp_nodelay=True)
            self._advertised = time.monotonic()

    def _keep(self, message, subject):
        topic, kind = subject
        if message._connection_header['md5sum'] != kind._md5sum:  # it is of another version
            return
        if topic == 'deflection':
            self._batches.append((time.monotonic(), NumpyDeflection().deserialize(message._buff)))
        elif topic == 'impacts':
            self._keep_impacts(message._buff)
        else:
            if topic == 'applied':
                self._applied.append(Applied().deserialize(message._buff))
            former, self._raw[topic] = self._raw.get(topic), message._buff
            if topic == 'configuration' and message._buff != former or topic == 'status' and former is not None \
                    and read_seq(message._buff) < read_seq(former):  # two may begin with equal bytes, on a model clock
                self._raw.pop('friction', None)
                self.run += 1
            self._heard = time.monotonic()

    def _keep_impacts(self, data):
        epoch, _, table = read_impacts(data)
        impacts = read_seq(data), epoch, table
        with contextlib.suppress(IndexError):  # the window may have taken them all
            if impacts[0] < self._impacts[-1][0]:
                self._impacts = collections.deque(maxlen=WAITING_BATCHES)  # another emulator of that name
        self._impacts.append(impacts)

    def _keep_diagnostics(self, message):
        for status in message.status:
            node, _, what = status.name.partition(':')
            if node.strip() == self.name.lstrip('/'):
                self.diagnostics[what.strip()] = status

    # what goes

    def command(self, topic, value):
        with contextlib.suppress(rospy.ROSException, AttributeError):  # it is just advertised anew
            self._commands[topic].publish(value)

    def set_parameter(self, name, value):
        """A slider may ask for more than is done: the last value of each counts."""
        with self._lock:
            self._wanted[name] = value
        self._jobs.put(self._set_wanted)

    def call(self, service, kind, **request):
        self._jobs.put(lambda: self._call(service, kind, **request))

    def pause(self, paused):
        self.call('pause', SetBool, data=paused)

    def step(self, **how_far):
        self.call('step', Step, **how_far)

    def reset(self):
        self.call('reset', Trigger)

    def record(self, on):
        if on:
            self.call('start_recording', StartRecording, name='')
        else:
            self.call('stop_recording', Trigger)

    def _set_wanted(self):
        with self._lock:
            wanted, self._wanted = self._wanted, {}
        if wanted:
            config = Config(doubles=[DoubleParameter(name, value) for name, value in wanted.items()])
            answer = self._call('set_parameters', Reconfigure, config=config)
            got = {value.name: value.value for value in answer.config.doubles}
            refused = [name for name, value in wanted.items() if got.get(name) != value]
            if refused:
                self.notes.append('%s was refused, or cut to its range' % ', '.join(refused))

    def _call(self, service, kind, **request):
        name = '%s/%s' % (self.name, service)
        try:
            connection = Connection(name, kind, time.monotonic() + SERVICE_S)
            with contextlib.closing(connection):
                answer = connection.call(kind._request_class(**request), time.monotonic() + ANSWER_S)
        except OSError as fault:
            raise OSError('%s: %s' % (service, fault)) from fault
        if not getattr(answer, 'success', True):
            self.notes.append('%s: %s' % (service, answer.message))
        return answer

    def _work(self):
        while True:
            job = self._jobs.get()
            try:
                if job is None:
                    return
                job()
            except Exception as fault:  # the knobs are worked on after it, too
                self.notes.append(str(fault))

"""Shared by the tests of the node: its topics, and waiting with deadlines."""
import os
import threading
import time

import rospy
from afm_emulator.client import tau_between  # noqa: F401
from afm_emulator.msg import Applied, Configuration, Deflection, EmulatorStatus, Friction, ImpactArray, Snapshot
from afm_emulator.subscription import Subscription

NAMESPACE = '/afm'
TOPICS = {'deflection': Deflection, 'impacts': ImpactArray, 'friction': Friction, 'applied': Applied,
          'status': EmulatorStatus, 'configuration': Configuration, 'snapshot': Snapshot}

PATIENCE = float(os.environ.get('AFM_PATIENCE', '1'))  # under a sanitizer all takes longer
DEADLINE_S = 60.0  # a launch takes two seconds, and twenty on a machine that builds three other things

_news = threading.Condition()


def wait_until(condition, what, deadline_s=DEADLINE_S):
    """What condition() returns as soon as that is true. Looks again at every message, and 20 times a second."""
    end = time.monotonic() + deadline_s * PATIENCE
    with _news:
        while True:
            result = condition()
            if result:
                return result
            if time.monotonic() > end:
                raise AssertionError('not within %g s: %s' % (deadline_s * PATIENCE, what))
            _news.wait(0.05)


def key(model_time):
    """Orders model times; equal only when they are equal to the bit."""
    return (model_time.tau, model_time.phase)


class Topic:
    """Keeps every message in order of arrival, as it came over the wire and decoded."""
    _open = []

    def __init__(self, name, kind=None):
        self.name, self.kind = name, kind or TOPICS[name.rsplit('/', 1)[-1]]
        self.raw, self.messages, self._epoch = [], [], 0
        path = self.name if self.name.startswith('/') else NAMESPACE + '/' + self.name
        self._subscription = Subscription(path, rospy.AnyMsg, self._take, buff_size=1 << 20)
        Topic._open.append(self)

    def _wait_until(self, condition, what, deadline_s=DEADLINE_S):
        def looked_after():
            self._subscription.ask_again()
            return condition()
        return wait_until(looked_after, self.name + ': ' + what, deadline_s)

    def connections(self):
        return self._subscription.connections()

    def wait_for_connection(self):
        """rospy counts a connection before it is made; the publisher's header says that it is."""
        self._wait_until(lambda: any(c.header for c in self.connections()), 'connected')

    def close(self):
        self._subscription.close()
        Topic._open.remove(self)

    @staticmethod
    def close_all(but=()):
        for topic in list(Topic._open):
            if topic not in but:
                topic.close()

    @staticmethod
    def all_open():
        return list(Topic._open)

    def forget_before(self, epoch):
        """Messages of earlier epochs, also those that are still on their way."""
        with _news:
            self._epoch = epoch
            kept = [i for i, m in enumerate(self.messages) if m.epoch >= epoch]
            self.messages[:], self.raw[:] = [self.messages[i] for i in kept], [self.raw[i] for i in kept]

    def _take(self, message):
        # rospy may hand on what is latched twice; ours are numbered
        twice = message._connection_header['latching'] == '1' and self.raw and self.raw[-1] == message._buff
        if twice and 'header' in self.kind.__slots__:
            return
        decoded = self.kind().deserialize(message._buff)
        with _news:
            if getattr(decoded, 'epoch', self._epoch) < self._epoch:
                return
            self.raw.append(message._buff)
            self.messages.append(decoded)
            _news.notify_all()

    def wait_for(self, wanted=lambda message: True, what='a message', begin=0, deadline_s=DEADLINE_S):
        """The first message from the `begin`-th on that is wanted. Each is judged once, when it has come."""
        unseen = begin

        def found():
            nonlocal unseen
            begin, unseen = unseen, len(self.messages)
            return next((m for m in self.messages[begin:unseen] if wanted(m)), None)
        return self._wait_until(found, what, deadline_s)

    def wait_for_next(self, wanted=lambda message: True, what='a message'):
        return self.wait_for(wanted, what, begin=len(self.messages))

    def wait_for_more(self, count):
        target = len(self.messages) + count
        self._wait_until(lambda: len(self.messages) >= target, '%d more' % count)

"""What the example controllers share: commands that wait until they have taken effect, and mean lateral forces."""
import collections
import math
import threading
import time

import rospy
from afm_emulator.msg import AppliedDrag, AppliedParameters, Configuration, Deflection
from std_msgs.msg import Float64

AGAIN_S = 1.0     # of wall time: a command without effect is published again, as the emulator may have been restarted
PATIENCE_S = 10.0  # then it counts as refused


Applied = collections.namedtuple('Applied', 'epoch time')  # since when a command holds


class Client:
    def __init__(self, name):
        self.news = threading.Condition()
        self.latest = {}                      # of each latched topic
        self.batches = collections.deque(maxlen=1000)
        self.samples_lost, self.next_sample = 0, None
        self.publishers = {topic: rospy.Publisher(name + '/' + topic, Float64, queue_size=10, tcp_nodelay=True)
                           for topic in ('drag_velocity', 'rest_height')}
        for topic, kind in (('configuration', Configuration), ('applied_drag', AppliedDrag),
                            ('applied_parameters', AppliedParameters)):
            rospy.Subscriber(name + '/' + topic, kind, lambda m, topic=topic: self.keep(topic, m), tcp_nodelay=True)
        rospy.Subscriber(name + '/deflection', Deflection, self.take_batch, tcp_nodelay=True, buff_size=1 << 22)
        self.wait_for(lambda: 'applied_parameters' in self.latest and 'configuration' in self.latest)

    def keep(self, topic, message):
        with self.news:
            self.latest[topic] = message
            self.news.notify_all()

    def take_batch(self, batch):
        """A gap in first_sample is a lost message. With a new epoch the count begins again."""
        label = (batch.epoch, batch.first_sample)
        with self.news:
            if self.next_sample is not None and label[0] == self.next_sample[0]:
                self.samples_lost += label[1] - self.next_sample[1]
            self.next_sample = (batch.epoch, batch.first_sample + len(batch.lateral))
            self.batches.append(batch)
            self.news.notify_all()

    def wait_for(self, condition, seconds=math.inf):
        """Whether it came true in that time."""
        end = time.monotonic() + seconds
        with self.news:
            while not condition():
                if rospy.is_shutdown():
                    raise rospy.ROSInterruptException('shut down')
                if time.monotonic() > end:
                    return False
                self.news.wait(0.05)
        return True

    def command(self, topic, value, applied_topic, field):
        """Publishes the value and waits until it holds. Returns an Applied: from which model time on.

        The emulator reports changes alone. If the value holds already, it is the time of the newest report or batch.
        """
        def holds():
            applied = self.latest.get(applied_topic)
            return applied and applied.epoch == self.latest['configuration'].epoch and getattr(applied, field) == value
        if holds():
            self.batches.clear()
            self.wait_for(lambda: len(self.batches) > 0)
            reports = [self.latest[name] for name in ('applied_drag', 'applied_parameters')] + [self.batches[-1]]
            newest = max(reports, key=lambda m: (m.epoch, m.time.tau, m.time.phase))
            return Applied(newest.epoch, newest.time)
        end = time.monotonic() + PATIENCE_S
        while not holds():
            if time.monotonic() > end:
                raise RuntimeError('%s = %g had no effect within %g s: refused?' % (topic, value, PATIENCE_S))
            self.publishers[topic].publish(value)
            self.wait_for(holds, AGAIN_S)
        return Applied(self.latest[applied_topic].epoch, self.latest[applied_topic].time)

    def set_drag_velocity(self, metres_per_second):
        return self.command('drag_velocity', metres_per_second, 'applied_drag', 'drag_velocity')

    def set_rest_height(self, metres):
        return self.command('rest_height', metres, 'applied_parameters', 'rest_height_m')

    def mean_force(self, applied, settle_s, window_s):
        """Mean force of the holder on the tip along +x [N], k_h = m omega_h^2 times minus the extension. The window
        begins settle_s of model time after the command. None if the emulator was reset meanwhile."""
        c = self.latest['configuration']
        tau_s = 2 * math.pi / c.omega_v_rad_per_s
        total, count, seconds = 0.0, 0, 0.0
        while seconds < window_s:
            self.wait_for(lambda: len(self.batches) > 0)
            batch = self.batches.popleft()
            if batch.epoch > applied.epoch:
                return None
            age = ((batch.time.tau - applied.time.tau) + (batch.time.phase - applied.time.phase)) * tau_s
            if batch.epoch == applied.epoch and age >= settle_s:
                total += sum(batch.lateral)
                count += len(batch.lateral)
                seconds += len(batch.lateral) * batch.sample_period
        return -c.tip_mass_kg * c.omega_h_rad_per_s ** 2 * total / count

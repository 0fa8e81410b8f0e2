"""A subscriber that finds its publisher."""
import math
import threading
import time

import rospy

ASK_AGAIN_S = 5.0  # twice at once would lose messages: a slow publisher has this long to answer


class Subscription:
    """Subscribes. rospy misses a publisher that the master names while it still answers who was there before: so
    ask_again(), which is called now and then, subscribes anew while nobody is connected."""

    def __init__(self, topic, kind, take, *arguments, **options):
        self._subscribe = lambda: rospy.Subscriber(topic, kind, take, *arguments, tcp_nodelay=True, **options)
        self.subscriber, self._asked = self._subscribe(), time.monotonic()

    def ask_again(self):
        if time.monotonic() > self._asked + ASK_AGAIN_S and self.subscriber.get_num_connections() == 0:
            self._asked = math.inf
            threading.Thread(target=self._ask, daemon=True).start()  # a master that is gone lets one wait

    def _ask(self):
        self.subscriber.unregister()
        self.subscriber = self._subscribe()
        self._asked = time.monotonic()

    def close(self):
        self._asked = math.inf  # it is not made again
        self.subscriber.unregister()

    def connections(self):
        return self.subscriber.impl.connections if self.subscriber.impl else []

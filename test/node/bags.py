"""Shared by the tests of recording: what is in a bag, and what is published, message for message."""
import functools

import rosbag

from topics import NAMESPACE, TOPICS, Topic

BEGINNING = ('configuration', 'applied', 'snapshot')  # of every bag


def short(topic):
    return topic[len(NAMESPACE) + 1:]


def alter(message, **values):
    """a__b=value: field b of the field a."""
    for path, value in values.items():
        *parts, field = path.split('__')
        setattr(functools.reduce(getattr, parts, message), field, value)


def read(path, raw=False):
    """The messages of each topic, or their bytes, in order; an empty list where there are none."""
    messages = {name: [] for name in TOPICS}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages(raw=raw):
            messages[short(topic)].append(message[1] if raw else message)
    return messages


def listen():
    topics = {name: Topic(name) for name in TOPICS}
    for topic in topics.values():  # else the first messages of a recording may have gone by
        topic.wait_for_connection()
    return topics


def count(topics):
    return {name: len(topic.raw) for name, topic in topics.items()}


def assert_no_gap(test, deflection):
    """Between messages of ~deflection."""
    test.assertGreater(len(deflection), 1)
    for message, following in zip(deflection, deflection[1:]):
        test.assertEqual(message.first_sample + len(message.vertical), following.first_sample)

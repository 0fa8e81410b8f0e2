"""Shared by the tests of recording: what is in a bag, and what is published, message for message."""
import subprocess

import rosbag

from topics import NAMESPACE, TOPICS, Topic


BEGINNING = ('configuration', 'applied', 'snapshot')  # of every bag


def info_exit_code(path):
    return subprocess.run(['rosbag', 'info', path], stdout=subprocess.DEVNULL).returncode


def short(topic):
    return topic[len(NAMESPACE) + 1:]


def read(path):
    """The messages of each topic, in order; an empty list where there are none."""
    messages = {name: [] for name in TOPICS}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages():
            messages[short(topic)].append(message)
    return messages


def read_raw(path):
    """The same as bytes."""
    messages = {name: [] for name in TOPICS}
    with rosbag.Bag(path) as bag:
        for topic, (_, data, _, _, _), _ in bag.read_messages(raw=True):
            messages[short(topic)].append(data)
    return messages


def listen():
    return {name: Topic(name) for name in TOPICS}


def count(topics):
    return {name: len(topic.raw) for name, topic in topics.items()}


def assert_no_gap(test, messages, first='first_sample', content='vertical'):
    """In the running index of a topic."""
    test.assertGreater(len(messages), 1)
    for message, following in zip(messages, messages[1:]):
        test.assertEqual(getattr(message, first) + len(getattr(message, content)), getattr(following, first))


def assert_sound(test, path):
    """A closed bag that holds a run without a gap, and its configuration. Returns what read() does."""
    test.assertEqual(info_exit_code(path), 0)
    messages = read(path)
    assert_no_gap(test, messages['deflection'])
    assert_no_gap(test, messages['impacts'], 'first_index', 'impacts')
    test.assertTrue(messages['configuration'] and messages['applied'])
    return messages

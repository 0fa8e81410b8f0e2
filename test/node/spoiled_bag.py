"""A recording to spoil: its messages as bytes, which a test alters, loses or reorders and writes again."""
import copy
import tempfile
from io import BytesIO
from pathlib import Path

import dynamic_reconfigure.client
import genpy
import rosbag

import bags
from emulator_under_test import SPEED_UNIT, Emulator, NodeTest
from topics import NAMESPACE, TOPICS, Topic

BATCH = ('deflection', 'impacts', 'friction')  # its topics


class Entry:
    """A message of a bag as bytes, with all that it takes to write it again."""

    def __init__(self, topic, raw, stamp, header):
        self.topic, self.raw, self.stamp, self.header = topic[len(NAMESPACE) + 1:], raw, stamp, header
        self.path = topic

    def message(self):
        return TOPICS[self.topic]().deserialize(self.raw[1])

    def edit(self, **values):
        message = self.message()
        bags.alter(message, **values)
        buffer = BytesIO()
        message.serialize(buffer)
        self.raw = (self.raw[0], buffer.getvalue()) + self.raw[2:]

    def shifted(self, seconds):
        """The same, published and recorded so much later."""
        later = copy.copy(self)
        later.edit(header__stamp=self.message().header.stamp + genpy.Duration(seconds))
        later.stamp = self.stamp + genpy.Duration(seconds)
        return later

    def flip_last_bit(self, byte):
        data = bytearray(self.raw[1])
        data[byte] ^= 1
        self.raw = (self.raw[0], bytes(data)) + self.raw[2:]


class SpoiledBag(NodeTest):
    """The same good recording for all tests; each begins with all its messages."""
    holder = tempfile.TemporaryDirectory()
    directory, good, content = Path(holder.name), None, None

    @classmethod
    def setUpClass(cls):
        if SpoiledBag.good is None:
            SpoiledBag.record_run()

    @classmethod
    def record_run(cls):
        emulator = Emulator({'record': True, 'bag_directory': str(cls.directory), 'sample_rate_hz': 60000.0})
        try:
            deflection, applied = Topic('deflection'), Topic('applied')
            deflection.wait_for(lambda m: m.first_sample > 36000, 'part of a run')
            dynamic_reconfigure.client.Client(NAMESPACE, timeout=60).update_configuration({'rest_height_m': -2.0e-12})
            emulator.drag(2.0 * SPEED_UNIT)
            applied.wait_for(lambda m: m.drag_velocity == 2.0 * SPEED_UNIT, 'a command')
            deflection.wait_for(lambda m: m.first_sample > 90000, 'one and a half seconds')
            deflection.wait_for_more(30)  # behind the command, however late it came
            emulator.assert_alive()
            assert emulator.stop() == 0
        finally:
            emulator.clean_up()
        Topic.close_all()
        cls.good = next(cls.directory.glob('*.bag'))
        with rosbag.Bag(str(cls.good)) as bag:
            cls.content = list(bag.read_messages(raw=True, return_connection_header=True))

    def setUp(self):
        super().setUp()
        self.entries = [Entry(*message) for message in self.content]

    def of(self, topic):
        return [entry for entry in self.entries if entry.topic == topic]

    def batches(self, which):
        """All messages of a slice of them."""
        return [entry for topic in BATCH for entry in self.of(topic)[which]]

    def remove(self, *entries):
        self.entries = [e for e in self.entries if e not in entries]

    def write(self, name='spoiled.bag', **options):
        path = self.directory / name
        with rosbag.Bag(str(path), 'w', **options) as bag:
            for e in self.entries:
                bag.write(e.path, e.raw, e.stamp, raw=True, connection_header=e.header)
        return path

#!/usr/bin/python3
"""A reader of bags that shares no code with ROS gets the same digests. Run only where it is installed."""
import shutil
import subprocess
from pathlib import Path

import rosbag
from std_srvs.srv import Trigger

from emulator_under_test import SPEED_UNIT, Emulator, NodeTest, run
from topics import Topic

DIGESTS = Path(__file__).parent / 'running_digests.js'


def read(path):
    node = shutil.which('node') or shutil.which('nodejs')
    return subprocess.run([node, str(DIGESTS), str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True, timeout=60)


def with_another_bit(path):
    """In a sample of the first batch."""
    other = path.with_name('other.bag')
    with rosbag.Bag(str(path)) as bag, rosbag.Bag(str(other), 'w') as out:
        batches = 0
        for topic, message, stamp in bag.read_messages():
            if topic.endswith('/deflection') and batches == 0:
                message.vertical = (message.vertical[0] * (1 + 2**-52),) + message.vertical[1:]
                batches += 1
            out.write(topic, message, stamp)
    return other


class JavascriptReader(NodeTest):
    def record(self):
        directory = Path(self.temporary_directory())
        emulator = self.start(Emulator({'record': True, 'bag_directory': str(directory), 'sample_rate_hz': 60000.0}))
        deflection, applied = Topic('deflection'), Topic('applied_drag')
        for eta in (2.0, 0.0, 3.0):
            deflection.wait_for_more(50)
            emulator.drag(eta * SPEED_UNIT)
            applied.wait_for(lambda m: m.drag_velocity == eta * SPEED_UNIT, 'a command')
        self.assertTrue(emulator.call('reset', Trigger).success)
        deflection.wait_for(lambda m: m.epoch == 1 and m.first_sample > 60000, 'a second of another epoch')
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        return next(directory.glob('*.bag'))

    def test_the_same_digests(self):
        path = self.record()
        answer = read(path)
        self.assertEqual(answer.returncode, 0, answer.stdout)
        self.assertGreaterEqual(answer.stdout.count('agree'), 3, answer.stdout)
        answer = read(with_another_bit(path))
        self.assertEqual(answer.returncode, 1, answer.stdout)
        self.assertIn('not as recorded: samples', answer.stdout)


if __name__ == '__main__':
    run(JavascriptReader)

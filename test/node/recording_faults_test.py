#!/usr/bin/python3
"""The emulator is killed while it records, or asked to record where it cannot. recorder_test.cpp tests how a recording
ends by itself."""
import signal
import subprocess
from pathlib import Path

import bags
import checks
from emulator_under_test import Emulator, NodeTest, run
from topics import Topic

CHUNK_BYTES = 768 * 1024  # what rosbag writes at once


class RecordingFaults(NodeTest):
    def emulator_with(self, **parameters):
        emulator = self.start(Emulator(parameters))
        self.status, self.deflection = Topic('status'), Topic('deflection')
        self.status.wait_for()
        return emulator

    def test_killed(self):
        directory = Path(self.temporary_directory())
        emulator = self.emulator_with(record=True, bag_directory=str(directory))
        self.deflection.wait_for(lambda m: m.first_sample > 300000, 'one and a half seconds')
        emulator.stop(signal.SIGKILL)
        seen = self.deflection.messages[-1].first_sample
        path, = directory.iterdir()
        self.assertTrue(path.name.endswith('.bag.active'))
        answer = checks.replay_check(path)
        self.assertEqual(answer.code, checks.UNCHECKED, answer.text)
        self.assertIn('rosbag reindex', answer.text)
        subprocess.run(['rosbag', 'reindex', str(path)], check=True, stdout=subprocess.DEVNULL)
        checks.assert_identical(self, path)
        lost = seen - bags.read(str(path))['deflection'][-1].first_sample
        self.assertLess(16 * lost, 2 * CHUNK_BYTES)

    def test_asked_to_record_where_it_cannot(self):
        emulator = self.start(Emulator({'record': True, 'bag_directory': '/dev/null/bags'}))
        self.assertEqual(emulator.wait(), 1)
        self.assertIn('/dev/null', emulator.output())


if __name__ == '__main__':
    run(RecordingFaults)

#!/usr/bin/python3
"""The recorder meets what happens in laboratories: killed, no directory, the bag taken away."""
import os
import shutil
import signal
import subprocess
from pathlib import Path

from afm_emulator.srv import StartRecording
from std_srvs.srv import Trigger

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

    def end(self, emulator):
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)

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

    def test_a_directory_without_permission(self):
        directory = self.temporary_directory()
        os.chmod(directory, 0o500)
        # root may write anywhere; there sysfs is a directory in which nobody can make a file
        forbidden = '/sys/kernel' if os.access(directory, os.W_OK) else directory
        emulator = self.emulator_with(bag_directory=forbidden)
        answer = emulator.call('start_recording', StartRecording, name='run')
        self.assertFalse(answer.success)
        self.assertIn(forbidden, answer.message)
        self.end(emulator)

    def test_asked_to_record_where_it_cannot(self):
        emulator = self.start(Emulator({'record': True, 'bag_directory': '/dev/null/bags'}))
        self.assertEqual(emulator.wait(), 1)
        self.assertIn('/dev/null', emulator.output())

    def test_the_bag_is_taken_away(self):
        directory = Path(self.temporary_directory()) / 'bags'
        emulator = self.emulator_with(bag_directory=str(directory))
        self.assertTrue(emulator.call('start_recording', StartRecording, name='run').success)
        self.status.wait_for(lambda m: m.recording, 'recording')
        shutil.rmtree(str(directory))
        ended = self.status.wait_for(lambda m: not m.recording and m.recorder_error, 'ended by itself')
        self.assertIn('No such file', ended.recorder_error)
        self.assertFalse(emulator.call('stop_recording', Trigger).success)
        self.assertTrue(emulator.call('start_recording', StartRecording, name='again').success)
        self.end(emulator)
        checks.assert_identical(self, str(directory / 'again.bag'))

    def test_a_part_whose_name_is_taken(self):
        directory = Path(self.temporary_directory())
        (directory / 'run_001.bag').write_text('mine')
        emulator = self.emulator_with(bag_directory=str(directory), split_size_mb=1.0)
        self.assertTrue(emulator.call('start_recording', StartRecording, name='run').success)
        ended = self.status.wait_for(lambda m: not m.recording and m.recorder_error, 'ended by itself')
        self.assertIn('run_001.bag', ended.recorder_error)
        self.end(emulator)
        self.assertEqual((directory / 'run_001.bag').read_text(), 'mine')
        checks.assert_identical(self, str(directory / 'run.bag'))


if __name__ == '__main__':
    run(RecordingFaults)

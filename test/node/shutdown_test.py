#!/usr/bin/python3
"""However the node is asked to end while recording, the bag is closed and holds all that was published."""
import signal
from pathlib import Path

import bags
import checks
from emulator_under_test import Emulator, NodeTest, run
from topics import Topic


class Shutdown(NodeTest):
    def assert_leaves_a_good_bag(self, with_signal):
        directory = Path(self.temporary_directory())
        emulator = self.start(Emulator({'record': True, 'bag_directory': str(directory)}))
        deflection, status = Topic('deflection'), Topic('status')
        status.wait_for(lambda m: m.recording, 'recording')
        deflection.wait_for(lambda m: m.first_sample >= 100000, 'half a second of the run')
        emulator.assert_alive()
        seen = deflection.messages[-1].first_sample
        self.assertEqual(emulator.stop(with_signal), 0)
        paths = list(directory.iterdir())
        self.assertEqual([path.suffix for path in paths], ['.bag'])
        recorded = bags.assert_sound(self, str(paths[0]))['deflection']
        self.assertEqual(recorded[0].first_sample, 0)
        self.assertGreaterEqual(recorded[-1].first_sample, seen)
        checks.assert_identical(self, str(paths[0]))

    def test_sigint(self):
        self.assert_leaves_a_good_bag(signal.SIGINT)

    def test_sigterm(self):
        self.assert_leaves_a_good_bag(signal.SIGTERM)


if __name__ == '__main__':
    run(Shutdown)

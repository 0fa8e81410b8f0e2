"""Whenever the node is asked to end, it does so soon, and a recording is closed; recording_test.py tests SIGTERM.
AFM_STOPS: so many stops of shipped scenes at random moments; by default each scene once."""
import os
import random
import signal
import threading
import time
from pathlib import Path

import rosbag
import rospy
import yaml
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure

from emulator_under_test import SHARE, NodeTest, Process, find
from topics import DEADLINE_S, NAMESPACE, PATIENCE

SCENES = sorted((SHARE / 'config' / 'scenes').glob('*.yaml'))
STOPS = int(os.environ.get('AFM_STOPS', len(SCENES)))
SOON_S = 5.0
WITHIN_S = 1.5  # of its start a node is stopped


class Shutdown(NodeTest):
    def test_with_clients_that_change_parameters_until_the_end(self):
        """roscpp aborts where it publishes on a topic that is withdrawn, and the bag would stay open."""
        emulator = self.record(record=True)
        answered, ended, chance = threading.Semaphore(0), threading.Event(), random.Random(7)

        def change():
            while not ended.is_set():
                gamma = DoubleParameter('restitution_gamma', chance.uniform(0.3, 0.9))
                try:
                    rospy.ServiceProxy(NAMESPACE + '/set_parameters', Reconfigure)(config=Config(doubles=[gamma]))
                    answered.release()
                except (rospy.ServiceException, rospy.ROSException):  # it ends
                    time.sleep(0.001)

        clients = [threading.Thread(target=change) for _ in range(4)]
        emulator.assert_alive()
        for client in clients:
            client.start()
        try:
            for _ in range(20):
                self.assertTrue(answered.acquire(timeout=DEADLINE_S))
            self.assertEqual(emulator.stop(), 0)
        finally:
            ended.set()
        self.assertEqual([path.suffix for path in self.directory.iterdir()], ['.bag'])

    def start_scene(self, scene, name):
        parameters = yaml.safe_load(scene.read_text())
        parameters.update(record=True, bag_directory=str(self.directory / name),
                          level_table=str(scene.parents[1] / 'levels.csv'))
        rospy.set_param('/' + name, parameters)
        return self.start(Process([find('emulator_node'), '__name:=' + name]))

    def test_every_scene_ends_soon_at_any_moment(self):
        """Many at once; some are stopped before they have begun."""
        chance, ended = random.Random(11), 0
        self.directory = Path(self.temporary_directory())
        while ended < STOPS:
            wave = min(STOPS - ended, len(SCENES))
            nodes = [(self.start_scene(SCENES[i], 'stop_%d' % (ended + i)), SCENES[i].stem) for i in range(wave)]
            begin, moments = time.monotonic(), sorted((chance.uniform(0.0, WITHIN_S * PATIENCE), i)
                                                      for i in range(wave))
            for moment, i in moments:
                time.sleep(max(0.0, begin + moment - time.monotonic()))
                node, scene = nodes[i]
                begun = 'scheduler:' in node.output()
                node.child.send_signal(signal.SIGINT)
                asked = time.monotonic()
                code = node.wait(SOON_S)
                print('%-12s %.2f s after its start: ended with %d after %.2f s' %
                      (scene, moment, code, time.monotonic() - asked))
                self.assertIn(code, (0,) if begun else (0, -signal.SIGINT), scene + ': ' + node.output())
            ended += wave
        self.assertEqual([str(path) for path in self.directory.rglob('*.active')], [])
        for path in self.directory.rglob('*.bag'):  # of a node that was stopped before it ran the topics had no names
            with rosbag.Bag(str(path)) as bag:
                self.assertNotIn('', bag.get_type_and_topic_info().topics, path)

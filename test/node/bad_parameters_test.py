"""With parameters that cannot be, the node reports them in one error, ends with exit code 1 and has advertised nothing.
parameters_test.cpp tests which those are."""
import os
import threading
import xmlrpc.client
from socketserver import ThreadingMixIn
from xmlrpc.server import SimpleXMLRPCServer

from emulator_under_test import Emulator, NodeTest, Process, find
from topics import NAMESPACE


class MasterSpy(ThreadingMixIn, SimpleXMLRPCServer):
    """Stands between a node and the master and notes what the node asks for."""
    daemon_threads = True

    def __init__(self):
        super().__init__(('localhost', 0), logRequests=False)
        self.uri, self.calls = 'http://localhost:%d' % self.server_address[1], []
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def _dispatch(self, method, arguments):
        self.calls.append((method,) + arguments)
        return getattr(xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI']), method)(*arguments)

    def advertised(self):
        """Names in our namespace."""
        kinds = ('registerPublisher', 'registerService', 'registerSubscriber')
        return [call[2] for call in self.calls if call[0] in kinds and call[2].startswith(NAMESPACE + '/')]


class BadParameters(NodeTest):
    def test_a_name_that_cannot_be(self):
        for kind, argument in (('emulator_node', '__name:=a-b'), ('view_node', '_emulator:=a-b')):
            node = self.start(Process([find(kind), argument]))
            self.assertEqual(node.wait(), 1)
            self.assertIn('a-b', node.output())

    def test_all_faults_in_one_error(self):
        spy = MasterSpy()
        self.addCleanup(spy.server_close)
        self.addCleanup(spy.shutdown)
        emulator = self.start(Emulator({'restitution_gamma': 1.5, 'batch_rate_hz': 'fast', 'gama': 0.7},
                                       ROS_MASTER_URI=spy.uri))
        self.assertEqual(emulator.wait(), 1)
        error, = [line for line in emulator.output().splitlines() if 'ERROR' in line or 'FATAL' in line]
        for text in ('restitution_gamma = 1.5: ', 'batch_rate_hz = "fast": ', 'gama = 0.7: '):
            self.assertIn(text, emulator.output())
        # but for the two that roscpp gives every node to set its log levels
        self.assertEqual({'logger' in name for name in spy.advertised()}, {True}, spy.advertised())

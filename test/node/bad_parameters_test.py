"""With parameters that cannot be, the node reports them in one error, ends with exit code 1 and has advertised nothing.
parameters_test.cpp tests which those are."""
import os
import threading
import xmlrpc.client
from socketserver import ThreadingMixIn
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

from emulator_under_test import Emulator, NodeTest
from topics import NAMESPACE


class Handler(SimpleXMLRPCRequestHandler):
    rpc_paths = ('/', '/RPC2')


class MasterSpy(ThreadingMixIn, SimpleXMLRPCServer):
    """Stands between a node and the master and notes what the node asks for."""
    daemon_threads = True

    def __init__(self):
        super().__init__(('localhost', 0), requestHandler=Handler, logRequests=False)
        self.uri, self.calls = 'http://localhost:%d' % self.server_address[1], []
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def _dispatch(self, method, arguments):
        self.calls.append((method,) + arguments)
        return getattr(xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI']), method)(*arguments)

    def advertised(self):
        """Names in our namespace, without the two that roscpp gives every node to set its log levels."""
        names = [call[2] for call in self.calls if call[0] in ('registerPublisher', 'registerService',
                                                               'registerSubscriber')]
        return [name for name in names if name.startswith(NAMESPACE + '/') and 'logger' not in name]


class BadParameters(NodeTest):
    def start_spied_on(self, parameters):
        spy = MasterSpy()
        self.addCleanup(spy.server_close)
        self.addCleanup(spy.shutdown)
        return spy, self.start(Emulator(parameters, ROS_MASTER_URI=spy.uri))

    def test_the_spy_would_notice(self):
        spy, emulator = self.start_spied_on({})
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        self.assertIn(NAMESPACE + '/deflection', spy.advertised())

    def test_all_faults_in_one_error(self):
        spy, emulator = self.start_spied_on({'restitution_gamma': 1.5, 'batch_rate_hz': 'fast', 'gama': 0.7})
        self.assertEqual(emulator.wait(), 1)
        error, = [line for line in emulator.output().splitlines() if 'ERROR' in line or 'FATAL' in line]
        for text in ('restitution_gamma = 1.5: ', 'batch_rate_hz = "fast": ', 'gama = 0.7: '):
            self.assertIn(text, emulator.output())
        self.assertTrue(spy.calls)
        self.assertEqual(spy.advertised(), [])

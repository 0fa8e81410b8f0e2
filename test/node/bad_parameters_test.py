#!/usr/bin/python3
"""With parameters that cannot be, the node tells every fault, ends with exit code 1 and has advertised nothing."""
import math
import os
import threading
import xmlrpc.client
from socketserver import ThreadingMixIn
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

from emulator_under_test import Emulator, NodeTest, run
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

    def assert_refused(self, parameters, *complaints):
        spy, emulator = self.start_spied_on(parameters)
        self.assertEqual(emulator.wait(), 1)
        for text in complaints or parameters:
            self.assertIn(text, emulator.output())
        self.assertTrue(spy.calls)
        self.assertEqual(spy.advertised(), [])
        return emulator

    def test_the_spy_would_notice(self):
        spy, emulator = self.start_spied_on({})
        emulator.assert_alive()
        self.assertEqual(emulator.stop(), 0)
        self.assertIn(NAMESPACE + '/deflection', spy.advertised())

    def test_all_faults_in_one_error(self):
        parameters = {
            'restitution_gamma': 1.5, 'tip_mass_kg': -408e-12, 'omega_v_rad_per_s': math.nan, 'time_scale': 0.0,
            'batch_rate_hz': 'fast', 'sample_rate_hz': math.inf, 'gama': 0.7, 'friction_window_tau': -1.0,
            'model': 'spring', 'record': 'yes please', 'bag_directory': 5, 'max_drag_velocity': -1.0,
            'commands_eta': [3.4, 99.0], 'paused': 'no'}
        emulator = self.assert_refused(parameters)
        errors = [line for line in emulator.output().splitlines() if 'ERROR' in line or 'FATAL' in line]
        self.assertEqual(len(errors), 1, errors)

    def test_each_says_what_is_wrong(self):
        self.assert_refused({'tip_mass_kg': 'heavy', 'record': 1, 'drag_speed': 1e-5, 'time_scale': 200.0,
                             'rest_height_m': 0.06e-9, 'commands_eta': [1.0, 'fast']},
                            'tip_mass_kg = "heavy": must be a number', 'record = 1: must be true or false',
                            'drag_speed = 1e-05: there is no such parameter',
                            'time_scale = 200: must be between 1e-06 and 100', 'rest_height_m = 6e-11: ',
                            'element 1: must be a number')

    def test_a_lever_is_given_in_one_way(self):
        lever = {'spring_constant_n_per_m': 0.2, 'resonance_hz': 13e3, 'lateral_spring_constant_n_per_m': 88.2}
        self.assert_refused(dict(lever, tip_mass_kg=3e-11),
                            'tip_mass_kg = 3e-11: is given beside the spring constants and the resonance')
        self.assert_refused({'load_n': 1e-9, 'rest_height_m': -1e-9}, 'rest_height_m = -1e-09: is given beside load_n')
        emulator = self.assert_refused({'resonance_hz': 13e3, 'spring_constant_n_per_m': -0.2},
                                       'spring_constant_n_per_m = -0.2: ', 'lateral_spring_constant_n_per_m = 0: ')
        self.assertNotIn('resonance_hz = ', emulator.output())
        self.assert_refused({'load_n': -1e-9}, 'rest_height_m = 1.53')

    def test_drag_velocity_beyond_its_limit(self):
        self.assert_refused({'drag_velocity': -2e-5, 'max_drag_velocity': 1e-5}, 'max_drag_velocity = ',
                            'drag_velocity = -2')

    def test_a_limit_that_cannot_be_blames_nothing_else(self):
        for limit in (-1.0, math.nan):
            emulator = self.assert_refused({'max_drag_velocity': limit})
            self.assertNotIn(' drag_velocity', emulator.output())
            self.assertNotIn('\ndrag_velocity', emulator.output())

    def test_a_limit_below_the_default_speed_is_one_fault(self):
        emulator = self.assert_refused({'max_drag_velocity': 1e-6}, 'max_drag_velocity = ')
        self.assertEqual(emulator.output().count(' = 1e-06'), 1)
        self.assertNotIn('\ndrag_velocity = ', emulator.output())


if __name__ == '__main__':
    run(BadParameters)

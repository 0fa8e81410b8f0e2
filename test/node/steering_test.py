"""Model time goes as wall time does. Commands and live parameters take effect as they are reported, faulty ones are
counted and change nothing; without commands the drag stops. scripts/soak sends thousands, of every size."""
import math
import subprocess
import threading
import time

import dynamic_reconfigure.client
from dynamic_reconfigure.msg import Config
from std_srvs.srv import SetBool, Trigger

from emulator_under_test import SPEED_UNIT, TAU_S, Emulator, EmulatorTest, NodeTest
from topics import NAMESPACE, Topic, key, tau_between, wait_until

AT_START = {'restitution_gamma': 0.7, 'cutoff_speed': 1.66e-7, 'rest_height_m': 0.0, 'sample_rate_hz': 50000.0,
            'friction_window_tau': 1000.0, 'temperature_k': 0.0, 'quality_factor': 0.0, 'lateral_quality_factor': 0.0,
            'kicks_per_tau': 29.034}
STIFFNESS = 408e-12 * 40e3 ** 2  # of the vertical spring [N/m]
MOST = 1e-4  # max_drag_velocity [m/s]


class Steering(EmulatorTest):
    parameters = {'sample_rate_hz': 50000.0}

    def setUp(self):
        super().setUp()
        self.applied, self.deflection, self.friction = (self.topics[n] for n in ('applied', 'deflection', 'friction'))

    def change(self, **wanted):
        """Returns the message that says when it took effect."""
        before = len(self.applied.messages)
        answer = self.emulator.set(**wanted)
        self.assertEqual({name: answer[name] for name in wanted}, wanted)
        return self.applied.wait_for(lambda m: m.cause == 'parameters', str(wanted), before)

    def test_model_time_goes_as_wall_time_does(self):
        """For a second: a busy machine holds it up, and then it catches up."""
        def goes_along():
            begin, since = self.status_now(), time.monotonic()
            wait_until(lambda: time.monotonic() > since + 1.0, 'a second passes')
            ratio = tau_between(begin.time, self.status_now().time) * TAU_S / (time.monotonic() - since)
            return abs(ratio - 1.0) < 0.05
        wait_until(goes_along, 'a second in real time')
        self.topics['status'].wait_for_next(lambda m: abs(m.real_time_factor - 1.0) < 0.05, 'the status says so')

    def test_a_subscriber_whose_connection_has_ended_finds_the_emulator_again(self):
        """rospy alone does not: nor if it missed the emulator at the start, as the test nodes and the status line
        did."""
        status = self.topics['status']
        for connection in list(status.connections()):
            connection.close()
        wait_until(lambda: not status.connections(), 'it has ended')
        status.wait_for_next(what='connected again')

    def test_dynparam_and_clients_work(self):
        client = dynamic_reconfigure.client.Client(NAMESPACE, timeout=60)
        wait_until(lambda: {name: client.get_configuration(timeout=60)[name] for name in AT_START} == AT_START,
                   'clients are told of the reset')
        described = {d['name']: (d['min'], d['max']) for d in client.get_parameter_descriptions(timeout=60)}
        self.assertEqual(set(described), set(AT_START))
        self.assertEqual((described['restitution_gamma'], described['sample_rate_hz']), ((0.0, 1.0), (1e3, 1e6)))
        command = ['rosrun', 'dynamic_reconfigure', 'dynparam', 'set', NAMESPACE, 'restitution_gamma', '0.55']
        done = subprocess.run(command, timeout=60, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.applied.wait_for(lambda m: m.restitution_gamma == 0.55, 'dynparam is obeyed')
        self.assertEqual(client.update_configuration({'friction_window_tau': 640.0})['restitution_gamma'], 0.55)
        for quality in (1e13, 50000.0, 20000.0, 1000.0):  # beyond the slider, and back to its end
            self.assertEqual(client.update_configuration({'quality_factor': quality})['quality_factor'], quality)
        client.close()

    def test_a_change_takes_effect_at_a_batch_boundary_and_the_reply_follows(self):
        self.friction.wait_for_more(30)
        reported = self.change(restitution_gamma=0.4, rest_height_m=-1.0e-11, sample_rate_hz=80000.0)
        batch = self.deflection.wait_for(lambda m: m.first_sample == reported.first_sample, 'begins with that sample')
        self.assertEqual(key(batch.time), key(reported.time))
        # of a new grid
        self.assertEqual((reported.samples_per_batch, len(batch.vertical), batch.sample_period), (800, 800, 1 / 80000))
        later = self.deflection.wait_for(lambda m: m.first_sample == reported.first_sample + 16000, 'later')
        self.assertAlmostEqual(tau_between(reported.time, later.time), 16000 * reported.sample_period_tau, delta=1e-9)
        self.assertEqual((reported.model, math.isnan(reported.expected_error)), ('oscillator', True))
        # the friction of the other model is forgotten, and the running estimate is of this batch alone
        first = self.friction.wait_for(lambda m: key(m.begin) == key(reported.time), 'the first batch after it')
        self.assertLess(first.energy_loss, self.friction.messages[self.friction.messages.index(first) - 1].energy_loss)
        # while paused nothing but the change is reported: it is there before the reply
        self.begin(paused=True)
        self.emulator.set(restitution_gamma=0.5)
        self.applied.wait_for(lambda m: m.restitution_gamma == 0.5, 'reported')

    def test_a_change_right_after_a_reset_or_a_height_is_obeyed(self):
        """What clients are shown is a moment old: a value that equalled it was passed over, without a word."""
        for _ in range(10):
            self.emulator.call('reset', Trigger)
            type(self).epoch += 1
            self.assertEqual(self.emulator.set(restitution_gamma=0.6)['restitution_gamma'], 0.6)
        for _ in range(10):
            self.assertTrue(self.emulator.control(0.0, rest_height=-3e-11).success)
            self.assertEqual(self.emulator.set(rest_height_m=-1e-11)['rest_height_m'], -1e-11)
        applied = self.applied.wait_for(lambda m: m.epoch == self.epoch and m.number == 21, 'the last change')
        self.assertEqual((applied.rest_height_m, applied.restitution_gamma), (-1e-11, 0.6))

    def test_a_change_takes_back_nothing_that_it_does_not_name(self):
        """Behind a reset that waited for its batch, it once brought the old values back. Where a busy machine lets the
        step end before the others come, nothing waits, and the test is of an ordinary change."""
        self.change(restitution_gamma=0.5)
        self.pause(True)
        calls = [threading.Thread(target=lambda: self.step(tau=10000.0)),
                 threading.Thread(target=lambda: self.emulator.call('reset', Trigger))]
        for call in calls:  # each waits behind the one before
            call.start()
            time.sleep(0.005)
        self.emulator.set(friction_window_tau=500.0)
        for call in calls:
            call.join()
        type(self).epoch += 1
        epoch = self.applied.wait_for(lambda m: m.epoch == self.epoch and m.number == 0, 'the reset')
        self.assertEqual(epoch.restitution_gamma, 0.7)
        self.assertEqual(self.emulator.set()['restitution_gamma'], 0.7)

    def test_a_faulty_combination_puts_the_old_values_back_and_says_why(self):
        updates = Topic('parameter_updates', Config)
        in_force = self.emulator.set()
        faults = (('cutoff_speed', math.nan, 'finite'), ('rest_height_m', 6e-11, 'never touches'),
                  ('quality_factor', 0.05, 'at least 0.1'), ('quality_factor', math.inf, 'finite'))
        for name, value, reason in faults:
            before = len(updates.messages)
            # the good part of a faulty change is not taken either
            self.assertEqual(self.emulator.set(friction_window_tau=500.0, **{name: value}), in_force)
            self.assertRegex(self.emulator.output(), 'refused: %s = .*%s' % (name, reason))
            updates.wait_for(lambda m: {v.name: v.value for v in m.doubles} == in_force,
                             'clients see the old values', before)
        self.assertEqual([m.cause for m in self.applied.messages], ['epoch'])

    def test_height_and_load_are_commanded_by_topic_and_reported(self):
        for name, values in (('rest_height', [-1e-12 * (i + 1) for i in range(20)]), ('load', [1e-10, 2e-10, 0.0])):
            before, publisher = len(self.applied.messages), self.emulator.publisher(name)
            for value in values:
                publisher.publish(value)
            wait_until(lambda: len(self.applied.messages) == before + len(values), 'all are applied')
            applied = self.applied.messages[before:]
            self.assertEqual({m.cause for m in applied}, {name})
            expected = values if name == 'rest_height' else [-value / STIFFNESS for value in values]
            for message, height in zip(applied, expected):
                self.assertAlmostEqual(message.rest_height_m, height, delta=1e-15 * abs(height))
        refused = self.status_now().refused_commands
        junk = (('rest_height', 6e-11), ('rest_height', math.nan), ('load', math.inf), ('load', -1e-9),
                ('drag_velocity', math.nan), ('drag_velocity', -math.inf), ('drag_velocity', 1.0000001 * MOST))
        for name, value in junk:
            self.emulator.publisher(name).publish(value)
        self.topics['status'].wait_for(lambda m: m.refused_commands == refused + len(junk), 'refused and counted')
        self.assertEqual(len(self.applied.messages), 24)
        # the live parameter follows, and what a client does not name is not put back
        self.emulator.publisher('rest_height').publish(-2.5e-11)
        self.applied.wait_for(lambda m: m.rest_height_m == -2.5e-11)
        self.assertEqual(self.emulator.set(restitution_gamma=0.5)['rest_height_m'], -2.5e-11)
        # nor one that waits behind a step together with the change
        self.pause(True)
        before = len(self.applied.messages)
        step = threading.Thread(target=self.step, kwargs={'tau': 10000.0})
        step.start()
        self.emulator.publisher('rest_height').publish(-3.5e-11)
        self.emulator.set(restitution_gamma=0.6)
        step.join()
        wait_until(lambda: {m.cause for m in self.applied.messages[before:]} >= {'rest_height', 'parameters'},
                   'both are applied')
        self.assertEqual(self.applied.messages[-1].rest_height_m, -3.5e-11)
        self.emulator.drag(-MOST)
        self.applied.wait_for(lambda m: m.drag_velocity == -MOST, 'the fastest there is')


class Silence(NodeTest):
    def test_without_commands_the_drag_stops_and_a_pause_does_not_count(self):
        applied, status = Topic('applied'), Topic('status')
        emulator = self.start(Emulator({'command_timeout_s': 2.0, 'drag_velocity': 2.0 * SPEED_UNIT, 'paused': True}))
        applied.wait_for()
        self.assertTrue(emulator.call('pause', SetBool, data=False).success)
        stop = applied.wait_for(lambda m: m.cause == 'timeout', 'it stops by itself')
        self.assertEqual([m.drag_velocity for m in applied.messages], [2.0 * SPEED_UNIT, 0.0])
        self.assertGreater(key(stop.time), (0, 0.0))
        # with commands it goes on
        begin, count = time.monotonic(), len(applied.messages)
        while time.monotonic() - begin < 3.0:
            emulator.drag(SPEED_UNIT)
            status.wait_for_next()
        self.assertEqual({m.cause for m in applied.messages[count:]}, {'drag_velocity'})
        self.assertTrue(emulator.call('pause', SetBool, data=True).success)
        begin = time.monotonic()
        status.wait_for(lambda m: m.paused and time.monotonic() - begin > 2.5, 'time passes')
        count, resumed = len(applied.messages), time.monotonic()
        self.assertTrue(emulator.call('pause', SetBool, data=False).success)
        applied.wait_for(lambda m: m.cause == 'timeout', 'stops after the pause', count)
        self.assertGreaterEqual(time.monotonic() - resumed, 1.0)
        # nor does it begin the time anew
        emulator.drag(SPEED_UNIT)
        count, ends = len(applied.messages), time.monotonic() + 20.0
        while 'timeout' not in {m.cause for m in applied.messages[count:]}:
            self.assertLess(time.monotonic(), ends, 'pauses keep the drag of a silent controller')
            for paused in (True, False):
                self.assertTrue(emulator.call('pause', SetBool, data=paused).success)
            status.wait_for_next(lambda m: not m.paused)
        emulator.assert_alive()

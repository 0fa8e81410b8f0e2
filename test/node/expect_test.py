"""The test nodes expect, expect_sound and expect_repeats judge what they say, and refuse with a sentence what they
cannot judge."""
import math
import os
import runpy
import signal
import subprocess
import unittest
from pathlib import Path
from unittest import mock

import rospy
from afm_emulator import Client, expectations
from afm_emulator.msg import Configuration, EmulatorStatus, ModelTime
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from emulator_under_test import PACKAGE, SPEED_UNIT, Emulator, NodeTest, Process, connected_to, find, set_parameters
from topics import PATIENCE, Topic, wait_until

NAME = '/expect_under_test'
SPEED = 2.0 * SPEED_UNIT


def advance_after(set_up, tip):
    """Once the test node listens."""
    def of(case):
        set_up(case)
        wait_until(lambda: rospy.get_name() in connected_to('/afm/friction'), 'it listens')
        for _ in range(5):
            tip.control(0.05)
    return of


class Expect(NodeTest):
    def node(self, kind='expect', name=NAME, **parameters):
        """Under way, as rostest starts it."""
        set_parameters(parameters, name)
        self.results = Path(self.temporary_directory())
        return self.start(Process([find(kind), '__name:=' + name[1:], '--text',
                                   '--gtest_output=xml:%s/results.xml' % self.results]))

    def end(self, node):
        return node.wait(60.0), node.output()

    def assert_fails(self, node, sentence):
        code, said = self.end(node)
        self.assertEqual(code, 1, said)
        self.assertRegex(said, 'AssertionError: .*' + sentence)

    def assert_refused(self, sentence, kind='expect', **parameters):
        """By the test case of the node, run here. There is no emulator: it must not get as far as to wait for one."""
        set_parameters(dict(parameters, timeout_s=0.1), rospy.get_name())
        with mock.patch('afm_emulator.ending', create=True), mock.patch('afm_emulator.expectations.run') as run:
            runpy.run_path(find(kind))
        (_, case), _ = run.call_args
        name, = unittest.defaultTestLoader.getTestCaseNames(case)
        with self.assertRaisesRegex(AssertionError, sentence) as refused:
            case(name).debug()
        self.assertNotIn(' : ', str(refused.exception))  # with which unittest introduces a sentence

    def start_emulator(self):
        self.start(Emulator({'pace': 'lockstep', 'drag_velocity': SPEED}))
        self.tip = Client('/afm')

    def without_matplotlib(self):
        """A path of Python on which it cannot be imported."""
        directory = Path(self.temporary_directory())
        (directory / 'matplotlib.py').write_text('raise ImportError("no matplotlib here")\n')
        return '%s:%s' % (directory, os.environ['PYTHONPATH'])

    def sound(self, name, **parameters):
        """expect_sound, which hears a status. No node before had this name, whose connection might still be there."""
        node = self.node('expect_sound', name, **parameters)
        wait_until(lambda: name in connected_to('/afm/status'), 'it listens')
        count = len(self.statuses.messages)
        wait_until(lambda: len(self.statuses.messages) > count + 1, 'one was sent to it')
        return node

    def advance(self, *speeds):
        """By a period for each."""
        for speed in speeds or (None, None, None):
            self.tip.control(0.05, speed)

    def judged(self, advance, field, code=0, **parameters):
        """What expect says, which must end with this code. It listens before the emulator advances."""
        node = self.node(field=field, **parameters)
        wait_until(lambda: NAME in connected_to('/afm/' + field.split('/')[0]), 'it listens')
        advance()
        ended, said = self.end(node)
        self.assertEqual(ended, code, said)
        return said

    def test_what_is_expected_and_what_is_not(self):
        self.start_emulator()
        self.judged(self.advance, 'friction/drag_velocity', value=SPEED, within=1e-9, for_s=0.1)
        said = self.judged(self.advance, 'friction/drag_velocity', code=1, least=1.5 * SPEED, for_s=0.1)
        self.assertRegex(said, r'friction/drag_velocity = \S+ at model time \S+ s: expected \S+ to inf from')
        self.assertTrue(list(self.results.glob('*.png')), said)
        with mock.patch.dict('os.environ', PYTHONPATH=self.without_matplotlib()):
            said = self.judged(self.advance, 'friction/drag_velocity', code=1, least=1.5 * SPEED, for_s=0.1)
        self.assertRegex(said, r'friction/drag_velocity = \S+ at .* Its picture: none, .*; the bag')

    def test_a_run_that_is_further_is_judged_where_it_is_and_that_is_said(self):
        """Further than the default too."""
        self.start_emulator()
        for given in ({'after_s': 0.2}, {}):
            rospy.ServiceProxy('/afm/reset', Trigger)()
            self.tip.control(0.5)
            said = self.judged(self.advance, 'friction/drag_velocity', least=0.0, for_s=0.1, **given)
            self.assertRegex(said, r'judged from 0\.5\d* s to 0\.6\d* s of model time, not from after_s = %g on'
                             % given.get('after_s', 0))

    def test_what_is_sound_in_a_run_that_is_further(self):
        """A command that is refused before the test listens counts with after_s at 0 alone. One that is refused while
        it listens always counts."""
        self.start_emulator()
        drag = rospy.Publisher('/afm/drag_velocity', Float64, queue_size=1)
        self.statuses = expectations.Follower('/afm/status', EmulatorStatus)
        self.addCleanup(self.statuses.subscription.close)

        def refuse(count):
            drag.publish(float('nan'))
            refused, _ = self.statuses.wait_for(lambda said: said and said[-1].refused_commands == count, 60 * PATIENCE)
            self.assertTrue(refused)

        wait_until(lambda: drag.get_num_connections(), 'it is connected')
        refuse(1)
        self.tip.control(0.5)
        node = self.sound('/sound_1', after_s=0.2, for_s=0.1)
        self.advance()
        code, said = self.end(node)
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r'/afm was judged from 0\.5\d* s to 0\.6\d* s of model time, not from after_s = 0.2 on')
        node = self.sound('/sound_2', after_s=0.2, for_s=0.1)
        refuse(2)
        self.advance()
        self.assert_fails(node, 'refused_commands = 1 more at model time')
        node = self.node('expect_sound', '/sound_3', for_s=0.1)
        self.assert_fails(node, 'refused_commands = 2 more at model time')

    def sound_of(self, name, *statuses, **parameters):
        """expect_sound, of an emulator that says this."""
        configuration = rospy.Publisher('/said/configuration', Configuration, queue_size=1, latch=True)
        configuration.publish(Configuration(omega_v_rad_per_s=2.0 * math.pi, lattice_spacing_m=5e-10, pace='real_time'))
        status = rospy.Publisher('/said/status', EmulatorStatus, queue_size=10)
        node = self.node('expect_sound', name, emulator='/said', for_s=2.0, **parameters)
        wait_until(lambda: status.get_num_connections(), 'it listens')
        for epoch, tau, numbers in statuses:
            numbers = dict({'real_time_factor': 1.0}, **numbers)
            status.publish(EmulatorStatus(epoch=epoch, time=ModelTime(tau=tau), **numbers))
        wait_until(lambda: node.child.poll() is not None, 'it has judged')
        configuration.unregister()
        status.unregister()
        return node

    def test_what_failed_before_a_reset_counts(self):
        """The counters of an epoch begin anew. With after_s later than 0 the latest epoch alone is judged."""
        said = (0, 1, {'search_failures': 1}), (1, 0, {}), (1, 2, {}), (1, 4, {})
        self.assert_fails(self.sound_of('/sound_4', *said), 'search_failures = 1 more at model time')
        code, text = self.end(self.sound_of('/sound_5', *said, after_s=1.0))
        self.assertEqual(code, 0, text)

    def test_real_time_is_kept_by_the_run_while_it_goes(self):
        """The factor is 1 until it is measured for the first time, and 0 in a pause."""
        paused = {'paused': True}
        self.assert_fails(self.sound_of('/sound_6', (0, 0, {}), (0, 2, {'lag': 0.7})), 'real time is not kept')
        late = (0, 1, {'lag': 0.7}), (0, 2, paused)
        self.assert_fails(self.sound_of('/sound_7', *late), 'lag 0.7 s, at model time 1 s: real time is not kept')
        code, text = self.end(self.sound_of('/sound_8', (0, 1, {}), (0, 2, dict(paused, lag=0.7))))
        self.assertEqual(code, 0, text)

    def test_a_recording_that_ended_early(self):
        full = {'recorder_error': 'the disk is full'}
        self.assert_fails(self.sound_of('/sound_9', (0, 1, {}), (0, 2, full)), 'ended early: the disk is full')

    def test_a_delay_that_was_made_up_is_none(self):
        """It may lower the factor of the second in which it was."""
        node = self.sound_of('/sound_10', (0, 1, {}), (0, 2, {'real_time_factor': 0.94, 'lag': 0.01}))
        self.assertEqual(self.end(node)[0], 0)
        node = self.sound_of('/sound_11', (0, 1, {}), (0, 2, {'real_time_factor': 0.94, 'lag': 0.2}))
        self.assert_fails(node, 'real time is not kept')

    def test_what_must_stay_zero(self):
        for name, said, words in (('/sound_12', {'budget_exhausted': 1}, 'budget_exhausted = 1 more'),
                                  ('/sound_13', {'dropped_messages': 1}, 'dropped_messages = 1 more'),
                                  ('/sound_14', {'worst_penetration': 5e-19}, 'the tip was 1e-09 a below')):
            self.assert_fails(self.sound_of(name, (0, 1, {}), (0, 2, said)), words)

    def test_an_emulator_that_is_started_again(self):
        """Its counters begin at zero, and so does its time."""
        first = self.start(Emulator())
        nodes = [self.node('expect_sound', '/again_sound', for_s=1e6),
                 self.node('expect', '/again', field='friction/eta', least=0.0, for_s=1e6)]
        for node, topic in zip(nodes, ('status', 'friction')):
            wait_until(lambda: node.child.args[1].split('=')[1] in ''.join(connected_to('/afm/' + topic)), 'it listens')
        Topic('status').wait_for_more(3)
        first.child.kill()
        self.start(Emulator())
        for node in nodes:
            self.assert_fails(node, 'the emulator was started again')

    def test_a_batch_counts_where_it_lies_wholly_within_the_time(self):
        """That before it was judged too, as it ends where the time begins, and the samples at its end."""
        self.start_emulator()
        for topic in ('friction', 'deflection'):
            rospy.ServiceProxy('/afm/reset', Trigger)()
            self.judged(lambda: self.advance(SPEED, SPEED, 2 * SPEED, 2 * SPEED, SPEED), topic + '/drag_velocity',
                        value=2 * SPEED, within=1e-9, after_s=0.1, for_s=0.1)

    def test_a_mean_is_one_over_time(self):
        def advance():
            for _ in range(10):
                self.tip.control(0.001, 2 * SPEED)
            for _ in range(20):
                self.tip.control(0.01, SPEED)
                self.tip.control(0.01, 2 * SPEED)
        self.start_emulator()
        for topic in ('friction', 'deflection'):
            rospy.ServiceProxy('/afm/reset', Trigger)()
            self.judged(advance, topic + '/drag_velocity', value=1.5 * SPEED, within=0.01 * SPEED, for_s=0.2, mean=True)

    def test_lost_messages_fail_it(self):
        """What happened in them is not known."""
        self.start_emulator()
        follower, take = expectations.Follower, expectations.Follower._take
        def lose_some(self, message):
            if message.header.seq % 4 or not hasattr(message, 'k_f'):
                take(self, message)
        set_parameters({'field': 'friction/drag_velocity', 'least': 0.0, 'for_s': 0.1}, rospy.get_name())
        with mock.patch('afm_emulator.ending', create=True), mock.patch('afm_emulator.expectations.run') as run:
            runpy.run_path(find('expect'))
        (_, case), _ = run.call_args
        with mock.patch.object(follower, '_take', lose_some), \
                mock.patch('afm_emulator.expectations.draw'), \
                mock.patch.object(case, 'setUp', advance_after(case.setUp, self.tip)):
            self.assertRaisesRegex(AssertionError, 'messages were lost on the way', case('test_field').debug)

    def test_a_status_next_to_the_time_counts(self):
        """In lockstep none may fall into it: ten come in a second of wall time."""
        def advance():
            for _ in range(3):
                rospy.wait_for_message('/afm/status', EmulatorStatus, timeout=60 * PATIENCE)
                self.tip.control(0.9)
        self.start_emulator()
        self.judged(advance, 'status/search_failures', most=0, after_s=1.0, for_s=0.01)

    def test_what_was_applied_holds_until_the_next(self):
        def judged(*speeds, **expected):
            rospy.ServiceProxy('/afm/reset', Trigger)()
            return self.judged(lambda: self.advance(*speeds), 'applied/drag_velocity', after_s=0.06, for_s=0.08,
                               **expected)
        self.start_emulator()
        judged(2 * SPEED, None, None, value=2 * SPEED, within=1e-9)
        said = judged(2 * SPEED, None, SPEED, value=SPEED, within=1e-9, code=1)
        self.assertIn('at model time 0.06 s', said)
        judged(2 * SPEED, None, SPEED, value=1.5 * SPEED, within=0.01 * SPEED, mean=True)  # 1 : 1
        said = judged(2 * SPEED, None, SPEED, most=SPEED, mean=True, code=1)
        self.assertIn('mean of applied/drag_velocity = ', said)

    def test_the_latest_epoch_is_judged(self):
        def advance():
            self.advance(None)  # too slow
            rospy.ServiceProxy('/afm/reset', Trigger)()
            self.advance(*[2 * SPEED] * 3)
        self.start_emulator()
        self.judged(advance, 'friction/drag_velocity', value=2 * SPEED, within=1e-9, for_s=0.1)

    def test_it_is_interrupted(self):
        """To draw a picture took longer than a node may go on."""
        self.start_emulator()
        node = self.node(field='friction/force', least=-1.0, for_s=1e6, timeout_s=1e6)
        wait_until(lambda: NAME in connected_to('/afm/friction'), 'it listens')
        node.child.send_signal(signal.SIGINT)
        self.assert_fails(node, 'No picture was drawn, as it was interrupted')

    def test_without_an_expectation(self):
        for given in ({}, {'within': 1.0}, {'value': 1.0}, {'value': 1.0, 'within': 1.0, 'least': 0.0}):
            self.assert_refused('there is no expectation', field='friction/eta', for_s=0.1, **given)
        self.assert_refused("least = 'x': must be a number", field='friction/eta', for_s=0.1, least='x')
        self.assert_refused('least = nan: must be a number', field='friction/eta', for_s=0.1, least=float('nan'))
        for given in ({'value': 1.0, 'within': float('inf')}, {'least': -float('inf')}):
            self.assert_refused('which any number is', field='friction/eta', for_s=0.1, **given)

    def test_unknown_parameters(self):
        """Each node ends at once: there is no emulator that could be waited for."""
        nodes = [(self.node(kind, '/%s_under_test' % kind, timeout_s=1000.0, **{wrong: 1.0}), wrong)
                 for kind, wrong in (('expect', 'witin'), ('expect_sound', 'keep_realtime'),
                                     ('expect_repeats', 'arguments_'))]
        for node, wrong in nodes:
            self.assert_fails(node, 'parameter %s is unknown' % wrong)

    def test_fields_that_cannot_be_judged(self):
        for field, reason in (('impacts/impacts.energy_loss', 'topic must be one of'), ('status/model', 'a string'),
                              ('friction/no_such', 'no field no_such'), ('friction', 'it must be TOPIC/FIELD'),
                              ('friction/header.stamp', 'a time is no number')):
            self.assert_refused('field = %s cannot be tested: .*%s' % (field, reason), field=field, for_s=0.1,
                                least=0.0)

    def test_names_that_no_node_can_have(self):
        for kind, given in (('expect', {'field': 'friction/eta', 'least': 0.0}), ('expect_sound', {})):
            for name in ('a b', '', 5):
                self.assert_refused('parameter emulator = %r: must be the name of a node' % (name,), kind, for_s=1.0,
                                    emulator=name, **given)

    def test_times_that_make_no_sense(self):
        self.assert_refused('parameter for_s = .*: must be finite and above 0', field='friction/eta', least=0.0,
                            for_s=0.0)
        for read, words, values in ((expectations.duration, 'above 0', (-1.0, 0.0, float('inf'))),
                                    (expectations.time_after, 'not negative', (-1.0, float('inf')))):
            for value in values:
                with mock.patch('rospy.get_param', return_value=value):
                    self.assertRaisesRegex(AssertionError, 'parameter t = .*: must be finite and ' + words, read, 't')
        self.assert_refused('parameter after_s = -1.0: must be finite and not negative', 'expect_sound', after_s=-1.0,
                            for_s=1.0)

    def repeats(self, number, program, other=''):
        """expect_repeats under way, with a program of the shell as the controller."""
        script, launch = (Path(self.temporary_directory()) / name for name in ('script', 'closed_loop.launch'))
        script.write_text('#!/bin/sh\n%s\n' % program)
        script.chmod(0o755)
        launch.write_text('''<launch>
          <arg name="bag_directory"/>
          <include file="$(find {0})/launch/test_fixture.launch">
            <arg name="bag_directory" value="$(arg bag_directory)"/>
          </include>
          <node pkg="{0}" type="replay_check" name="controller" required="true" launch-prefix="{1}"/>{2}
        </launch>'''.format(PACKAGE, script, other))
        return self.node('expect_repeats', '/repeats_%d' % number, launch=str(launch))

    def test_repeats_of_a_run_that_died_or_held_nothing_or_does_not_repeat(self):
        """All at once: each run has a master of its own."""
        advance = '{drag_velocity: 5.$(date +%N)e-06, rest_height: .nan, duration: 0.01}'
        runs = (('false', 'a node has died'), ('kill -SEGV $$', 'a node has died'), ('true', 'has recorded no batch'),
                ('rosservice call --wait /afm/control "%s"' % advance,
                 'of the runs differs: /afm/applied: drag_velocity: 5'))
        nodes = [self.repeats(number, program) for number, (program, _) in enumerate(runs)]
        misspelt = '<node pkg="%s" type="misspelt" name="other"/>' % PACKAGE
        nodes.append(self.repeats(len(runs), runs[-1][0], misspelt))
        for node, (_, sentence) in zip(nodes, runs + ((None, 'could not be started'),)):
            self.assert_fails(node, sentence)

    def test_arguments_that_the_launch_file_does_not_have(self):
        launch = Path(self.temporary_directory()) / 'closed_loop.launch'
        launch.write_text('<launch><arg name="bag_directory"/></launch>')
        self.assert_refused('arguments = bags:=x: unknown to .*, which has bag_directory', 'expect_repeats',
                            launch=str(launch), arguments='bags:=x')
        for arguments, fault in (('bag_directory', 'must be NAME:=VALUE'), (7, 'must be NAME:=VALUE'),
                                 ("bag_directory:='x", 'No closing quotation')):
            self.assert_refused('^arguments = %s: %s' % (arguments, fault), 'expect_repeats', launch=str(launch),
                                arguments=arguments)

    def test_a_launch_file_that_is_not_there(self):
        self.assert_refused('^launch = /no/such.launch: there is no such file', 'expect_repeats',
                            launch='/no/such.launch', arguments='bags:=x')

    def test_help_may_be_cut_short(self):
        said = [subprocess.Popen('"%s" --help | true' % find(kind), shell=True, stderr=subprocess.PIPE,
                                 universal_newlines=True) for kind in ('expect', 'expect_sound', 'expect_repeats')]
        for done in said:
            self.assertEqual(done.communicate(timeout=60 * PATIENCE)[1], '')

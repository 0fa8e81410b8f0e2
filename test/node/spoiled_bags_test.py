"""Whatever is altered, lost, renamed or filtered in a recording: both checks say what, in words and by their exit
codes. What is intact is never called damaged, and what is altered never identical."""
import copy
import re
import resource
import subprocess
from unittest import mock

import genpy
import rosbag
from std_msgs.msg import String

import checks
from checks import DIFFERS, SOUND, UNCHECKED, USAGE
from emulator_under_test import SPEED_UNIT, find
from spoiled_bag import BATCH, SpoiledBag
from terminal import run_on_a_terminal
from topics import NAMESPACE


class SpoiledBags(SpoiledBag):
    def assert_reported(self, code, *words, sound=None, path=None):
        """By replay_check; sound: what bag_check calls it, where that matters."""
        path = path or self.write()
        answer = checks.replay_check(path)
        self.assertEqual(answer.code, code, answer.text)
        for word in words:
            self.assertIn(word, answer.text)
        if sound is not None:
            audit = checks.bag_check(path)
            self.assertEqual(audit.code, SOUND if sound else DIFFERS, audit.text)

    def end_at_the_last_deflection(self):
        """As of a node that is killed within a batch."""
        end = self.of('deflection')[-1].stamp
        self.remove(*(entry for entry in self.entries if entry.stamp > end))

    def reset_at_the_end(self):
        """The first 40 batches come again: a reset begins the same run."""
        again = [copy.copy(e) for e in self.entries[:self.entries.index(self.of('friction')[40])]]
        for entry in again:
            of_epoch = {'header__seq': entry.message().header.seq + len(self.of(entry.topic)), 'epoch': 1}
            if entry.topic == 'snapshot':
                of_epoch['applied__epoch'] = of_epoch['configuration__epoch'] = 1
            entry.edit(**of_epoch)
            entry.stamp += self.entries[-1].stamp - self.entries[0].stamp + genpy.Duration(1)
        self.entries += again

    def spoil_each(self, *spoils):
        """(code, words, sound, spoil): each by itself."""
        for code, words, sound, spoil in spoils:
            with self.subTest(words=words):
                self.setUp()
                spoil()
                self.assert_reported(code, *words, sound=sound)

    def test_one_bit(self):
        """Of any byte fuzz_bag_messages tests it. The field is named, with the elements that it lies in."""
        impacts, deflection = (self.of(topic)[80].message() for topic in ('impacts', 'deflection'))
        impacts.impacts[1].time.phase = 0.5
        index = len(deflection.vertical) - 1
        self.spoil_each(
            (DIFFERS, ('message 80 of /afm/deflection', 'lateral[%d]' % index, 'last command: number'), None,
             lambda: self.of('deflection')[80].flip_last_bit(-8)),
            (DIFFERS, ('  vertical[%d]\n    recorded   none' % index,), None,
             lambda: self.of('deflection')[80].edit(vertical=deflection.vertical[:-1])),
            (DIFFERS, ('  impacts[1].time.phase\n    recorded   0.5\n',), None,
             lambda: self.of('impacts')[80].edit(impacts=impacts.impacts)),
            (DIFFERS, ('  impacts[%d]' % (len(impacts.impacts) - 1),), None,
             lambda: self.of('impacts')[80].edit(impacts=self.of('impacts')[80].message().impacts[:-1])),
            (DIFFERS, ('estimate_energy[', '/afm/snapshot'), None,
             lambda: self.of('snapshot')[0].edit(estimate_energy=[1e-300, 0.0])))

    def test_progress_is_shown(self):
        """It stood at 0."""
        code, text = run_on_a_terminal([find('replay_check'), str(self.write())])
        batches = len(self.of('friction'))
        shown = re.findall(r'(\d+)/%d batches' % batches, text)
        self.assertEqual((code, shown[-1]), (SOUND, str(batches)))
        self.assertLess(len(shown), batches)

    def test_one_altered_epoch(self):
        """It was blamed on another message and another time."""
        self.spoil_each((UNCHECKED, ('not compared: 1 batches', 'what was compared is identical'), None,
                         lambda: self.of('friction')[80].edit(epoch=7)),
                        (DIFFERS, ('message 80 of /afm/deflection', 'header.frame_id'), None,
                         lambda: self.of('deflection')[80].edit(header__frame_id='tip')))

    def test_what_was_applied(self):
        def edit(**values):
            self.of('applied')[1].edit(**values)
        self.spoil_each(
            (DIFFERS, ('first_sample',), None, lambda: edit(first_sample=3)),
            (DIFFERS, ('  number\n    recorded   0\n    simulated  1\n',), None, lambda: edit(number=0)),
            (DIFFERS, ('  epoch\n    recorded   2\n    simulated  1\n',), None,
             lambda: self.of('applied')[-1].edit(epoch=2, number=0)),
            (DIFFERS, ('expected_error',), None, lambda: edit(expected_error=0.25)),
            (DIFFERS, ('  epoch\n    recorded   16777216\n',), None,
             lambda: self.of('snapshot')[0].edit(epoch=1 << 24)),
            (DIFFERS, ('recorded',), None, lambda: edit(rest_height_m=-2.1e-12)),
            (UNCHECKED, ('CANNOT BE CHECKED', 'rest_height_m = 1'), None, lambda: edit(rest_height_m=1.0)),
            (UNCHECKED, ('CANNOT BE CHECKED', 'unknown model'), None, lambda: edit(model='nail')),
            # what a drag command does not change, though it acts on nothing
            (DIFFERS, ('temperature_k',), None, lambda: self.of('applied')[-1].edit(temperature_k=300.0)),
            (DIFFERS, ('contact_tolerance',), None, lambda: self.of('applied')[-1].edit(contact_tolerance=1e-4)),
            (UNCHECKED, ('1 commands, the first after', 'what was compared is identical'), False,
             lambda: self.remove(self.of('applied')[1])),
            # the last: no number tells of it, but friction does
            (UNCHECKED, ('missing: 1 commands', 'what was compared is identical'), None,
             lambda: self.remove(self.of('applied')[-1])),
            (DIFFERS, ('drag_velocity',), False,  # a command that the run did not get
             lambda: self.of('applied')[-1].edit(drag_velocity=2.1 * SPEED_UNIT)))

    def test_another_arithmetic(self):
        self.of('snapshot')[0].edit(configuration__arithmetic_digest='0' * 16)
        self.of('configuration')[0].edit(arithmetic_digest='0' * 16)
        self.assert_reported(UNCHECKED, 'CANNOT BE CHECKED: it was made by version', '0' * 16)

    def test_other_definitions_of_messages(self):
        for entry in self.of('friction'):
            entry.raw = entry.raw[:2] + ('0' * 32,) + entry.raw[3:]
            entry.header = dict(entry.header, md5sum='0' * 32)
        self.assert_reported(UNCHECKED, 'another version of afm_emulator/Friction')

    def test_messages_are_lost(self):
        for topic in BATCH:
            words = '3 messages of /afm/%s, the first after' % topic, 'what was compared is identical'
            self.spoil_each((UNCHECKED, words, False, lambda: self.remove(*self.of(topic)[80:83])))

    def test_messages_are_lost_beside_a_reset(self):
        """The last command before it was counted twice, and a configuration not at all."""
        def lose(topic, number):
            self.reset_at_the_end()
            self.remove(self.of(topic)[number])
        self.spoil_each((SOUND, ('IDENTICAL', '2 epochs'), True, self.reset_at_the_end),
                        (UNCHECKED, ('missing: 1 commands',), False, lambda: lose('applied', -2)),
                        (UNCHECKED, ('missing: 1 configurations',), False, lambda: lose('configuration', -1)))

    def test_a_hole_may_hide_a_snapshot(self):
        """At which the motion was split: a difference right behind it may be that in the last digits."""
        def lose_batches_before_a_difference(batch):
            self.of('deflection')[batch].flip_last_bit(-8)
            self.remove(*self.batches(slice(80, 83)))
        self.spoil_each((UNCHECKED, ('3 messages of /afm/friction', 'what was compared is identical'), False,
                         lambda: lose_batches_before_a_difference(83)),
                        (DIFFERS, ('message 90 of /afm/deflection',), False,
                         lambda: lose_batches_before_a_difference(90)))

    def test_begun_late_by_rosbag_record(self):
        """At the latched snapshot and command: what is altered later is still found. Where rosbag record repeats the
        latched messages of the beginning, another snapshot may have come."""
        def begin_late(batch, repeated=False):
            self.remove(*self.batches(slice(20)))
            snapshot = self.of('snapshot')[0]
            snapshot.stamp += genpy.Duration(0, 1000)
            for entry in self.entries[:3] if repeated else ():
                entry.header = {k: v for k, v in entry.header.items() if k != 'callerid'}
            self.of('deflection')[batch].flip_last_bit(-8)
        self.spoil_each((DIFFERS, ('message 30 of /afm/deflection',), None, lambda: begin_late(10)),
                        (DIFFERS, ('message 20 of /afm/deflection',), None, lambda: begin_late(0)),
                        (UNCHECKED, ('not compared:',), None, lambda: begin_late(0, True)))

    def test_messages_are_lost_at_the_ends(self):
        for topic in BATCH:
            words = 'missing: 3 messages of /afm/%s at the beginning' % topic, 'what was compared is identical'
            end = 'messages of /afm/%s at the end' % topic
            self.spoil_each((UNCHECKED, words, None, lambda: self.remove(*self.of(topic)[:3])),
                            (UNCHECKED, (end,), None, lambda: self.remove(*self.of(topic)[-5:])))
        def end_before_the_last_command():
            time = self.of('applied')[-1].message().time
            before = sum((m.time.tau, m.time.phase) < (time.tau, time.phase)
                         for m in (e.message() for e in self.of('friction')))
            self.remove(*self.batches(slice(before, None)), *self.of('status'))
        def tell_of_a_reset():
            self.of('status')[-1].edit(epoch=self.of('friction')[-1].message().epoch + 1)
        self.spoil_each((UNCHECKED, ('3 messages of /afm/friction at the beginning',), False,  # as the snapshot tells
                         lambda: self.remove(*self.batches(slice(3)))),
                        (UNCHECKED, ('messages of /afm/friction at the end',), False, end_before_the_last_command),
                        (UNCHECKED, ('messages of /afm/friction at the end',), False, tell_of_a_reset))
        self.spoil_each((SOUND, ('IDENTICAL',), None, self.end_at_the_last_deflection))
        def lose_the_last(topic):
            self.entries.append(copy.copy(self.of('status')[-1]))  # what stands behind a batch shows that it was whole
            self.entries[-1].stamp = self.entries[-2].stamp + genpy.Duration(0, 1)
            self.remove(self.of(topic)[-1])
        for topic in BATCH:
            self.spoil_each((UNCHECKED, ('1 messages of /afm/%s at the end' % topic,), False,
                             lambda: lose_the_last(topic)))
        self.spoil_each((UNCHECKED, ('5 messages of /afm/friction at the end',), False,  # as the status tells
                         lambda: self.remove(*self.batches(slice(-5, None)))),
                        (UNCHECKED, ('missing: 1 commands',), False, lambda: self.remove(self.of('applied')[0])))

    def test_rosbag_record_subscribes_to_topic_after_topic(self):
        def lose_by_rosbag(count):  # it stamps what comes in by itself
            self.of('snapshot')[0].stamp += genpy.Duration(0, 1)
            self.remove(*self.of('deflection')[:count], *self.of('friction')[:2], *self.of('impacts')[-2:])
        def alter_what_has_no_friction():
            lose_by_rosbag(0)
            self.remove(*self.of('friction')[-20:])
            self.of('impacts')[-10].edit(first_index=7)
        self.spoil_each((UNCHECKED, ('not compared: 1 batches without a message of friction',), None,
                         alter_what_has_no_friction),
                        (SOUND, ('IDENTICAL',), None, lambda: lose_by_rosbag(99)),
                        (UNCHECKED, ('101 messages of /afm/deflection',), None, lambda: lose_by_rosbag(101)))

    def test_rosbag_record_lost_more_than_waits_in_a_queue(self):
        """Other messages show up to which model time there were batches. Both checks once called it whole."""
        def lose_by_rosbag(count):
            self.of('snapshot')[0].stamp += genpy.Duration(0, 1)
            self.remove(*self.batches(slice(-count, None)))
        self.spoil_each((UNCHECKED, ('messages of /afm/friction at the end',), False, lambda: lose_by_rosbag(115)),
                        (SOUND, ('IDENTICAL',), True, lambda: lose_by_rosbag(20)))

    def test_two_starts_on_simulated_time(self):
        """Their messages may have the same numbers and stamps, or stand between those of the other start."""
        def start_again(back, **values):
            for entry in self.of('friction')[80:85]:
                other = copy.copy(entry)
                other.edit(header__seq=entry.message().header.seq - back, **values)
                other.stamp += genpy.Duration(0, 1)
                self.entries.append(other)
        words = ('another start of the node',)
        self.spoil_each((SOUND, ('IDENTICAL',), None, lambda: start_again(0)),  # said again
                        (UNCHECKED, words, None, lambda: start_again(0, force=1.0)),
                        (UNCHECKED, words, None, lambda: start_again(60)))

    def test_the_wall_clock_is_set_back(self):
        """To before the start of the node: what is latched has later stamps than all that follows."""
        for entry in self.entries[:2]:
            entry.edit(header__stamp=entry.message().header.stamp + genpy.Duration(3600))
        self.of('snapshot')[0].edit(header__seq=1)  # that of the recording, which begins later than the node
        self.assert_reported(SOUND, 'IDENTICAL', sound=True)
        for entry in self.entries:  # a part of a split one, whose stamps in the bag go on
            entry.stamp += genpy.Duration(3600)
        self.assert_reported(SOUND, 'IDENTICAL', sound=True)

    def test_two_starts(self):
        """On wall time each message is of one of them, whatever is lost."""
        def lose(*topics, which=slice(None)):
            later = [entry.shifted(100) for entry in self.entries]
            for topic in topics:
                self.remove(*self.of(topic)[which])
            self.entries += later

        def end_with(topic, number):
            self.entries.append(copy.copy(self.of(topic)[number]))
            self.entries[-1].stamp = self.entries[-2].stamp + genpy.Duration(1)
        def take_over():
            """The first goes on for two batches, as roscpp gives its name to the second meanwhile."""
            later = [entry.shifted(100) for entry in self.entries]
            old = self.batches(slice(-2, None))
            for entry in old:
                entry.edit(header__stamp=later[0].message().header.stamp + genpy.Duration(0, 1000))
                entry.stamp = later[0].stamp + genpy.Duration(0, 1000)
            self.remove(*old)
            self.entries += later[:3] + old + later[3:]
        def record_behind():
            lose()
            for entry in self.entries:
                entry.stamp -= genpy.Duration.from_sec(0.05)
            answer = checks.call('bag_to_csv', '--topic', 'commands', self.write())
            self.assertEqual(answer.code, SOUND, answer.text)
        def lose_of_a_short_start():
            later = [entry.shifted(100) for entry in self.entries[:self.entries.index(self.of('friction')[70]) + 1]]
            self.entries[2].stamp += genpy.Duration(0, 1)  # as by rosbag record
            self.entries += [entry for entry in later if entry.topic != 'impacts']
        batches = len(self.of('friction'))
        self.spoil_each(
            (UNCHECKED, ('still running when another node took its name',), False, take_over),
            (SOUND, ('IDENTICAL', '%d batches' % (2 * batches), '2 epochs'), True, lose),
            (UNCHECKED, ('not compared: %d batches' % batches, 'what was compared is identical'), None,
             lambda: lose('configuration', 'applied', 'snapshot')),
            (UNCHECKED, ('%d messages of /afm/deflection at the beginning' % batches,), False,
             lambda: lose('deflection')),
            # stamped by a machine whose clock is behind: the restart was taken for a lost command
            (SOUND, ('IDENTICAL', '2 epochs'), True, record_behind),
            # a whole topic of the second start, of fewer batches than may wait in a queue
            (UNCHECKED, ('71 messages of /afm/impacts at the beginning of a start',), False, lose_of_a_short_start),
            # at the inner ends, where once nothing was missed
            (UNCHECKED, ('5 messages of /afm/impacts at the end of a start',), False,
             lambda: lose('impacts', which=slice(-5, None))),
            (UNCHECKED, ('5 messages of /afm/friction at the end of a start',), False,
             lambda: lose('deflection', 'friction', 'impacts', which=slice(-5, None))),
            (UNCHECKED, ('/afm/deflection: number 9 comes behind',), True, lambda: end_with('deflection', 9)))

    def test_a_snapshot(self):
        self.spoil_each((DIFFERS, ('restitution_gamma', 'of /afm/snapshot holds, and either may be wrong'), None,
                         lambda: self.of('snapshot')[0].edit(configuration__restitution_gamma=0.5)),
                        (UNCHECKED, ('the snapshot at model time 7 + 0 tau of epoch 0: ',), None,
                         lambda: self.of('snapshot')[0].edit(time__tau=7)))

    def test_a_topic_is_filtered_out(self):
        self.spoil_each(
            (SOUND, ('IDENTICAL in what it holds; it holds no deflection',), True,
             lambda: self.remove(*self.of('deflection'))),
            (SOUND, ('IDENTICAL in what it holds; it holds no impacts',), True,
             lambda: self.remove(*self.of('impacts'))),
            (SOUND, ('IDENTICAL',), True, lambda: self.remove(*self.of('status'), *self.of('configuration'))),
            (UNCHECKED, ('holds no message of friction',), None, lambda: self.remove(*self.of('friction'))),
            (UNCHECKED, ('holds no message of what was applied',), None, lambda: self.remove(*self.of('applied'))),
            (UNCHECKED, ('holds no snapshot',), None, lambda: self.remove(*self.of('snapshot'))))

    def test_physics_alone_is_left(self):
        """Without a configuration or a snapshot the units are not known: bag_check once gave up."""
        self.remove(*self.of('configuration'), *self.of('snapshot'), *self.of('applied'))
        self.assertEqual(checks.bag_check(self.write()).code, SOUND)
        self.remove(*(entry for entry in self.entries if entry.topic not in ('friction', 'impacts')))
        self.assertEqual(checks.bag_check(self.write()).code, SOUND)

    def test_renamed_and_in_any_order(self):
        """As `rosbag record` writes it down: in the order of arrival, under the names to which topics are remapped."""
        for i, entry in enumerate(self.entries):
            entry.path = {'friction': '/force', 'impacts': '/bounces'}.get(entry.topic, entry.path)
            delay = {'deflection': 0.05, 'applied': 0.4, 'snapshot': 0.8}.get(entry.topic, 0.0)
            entry.stamp = entry.stamp + genpy.Duration.from_sec(delay)
        self.entries.sort(key=lambda e: e.stamp)
        self.assert_reported(SOUND, 'IDENTICAL', sound=True)

    def test_two_emulators(self):
        """Each by itself; but where another program published both, nothing says which topics belong together."""
        path = self.directory / 'two.bag'
        for callers, code, words in ((('/afm', '/other'), SOUND, '/other in'),
                                     (('/play', '/play'), UNCHECKED, 'nothing says')):
            with rosbag.Bag(str(path), 'w') as bag:
                for e in self.entries:
                    for space, caller in zip((NAMESPACE, '/other'), callers):
                        topic = space + '/' + e.topic
                        bag.write(topic, e.raw, e.stamp, raw=True,
                                  connection_header=dict(e.header, topic=topic, callerid=caller))
            self.assert_reported(code, words, path=path, sound=True if code == SOUND else None)
        self.assertEqual(checks.bag_check(path).code, UNCHECKED)
        self.assertEqual(checks.replay_check(self.good, '--node', '/other').code, UNCHECKED)
        self.assertIn('named /other, but of %s' % NAMESPACE, checks.bag_check(self.good, '--node', '/other').text)
        self.assertEqual(checks.replay_check(self.good, '--node', NAMESPACE).code, SOUND)

    def test_what_is_no_closed_bag(self):
        data = self.good.read_bytes()
        cut, text, empty = (self.directory / name for name in ('cut.bag', 'text.bag', 'empty.bag'))
        cut.write_bytes(data[:len(data) * 2 // 3])
        text.write_text('not a bag')
        empty.touch()
        foreign = self.directory / 'foreign.bag'
        with rosbag.Bag(str(foreign), 'w') as bag:
            bag.write('/chatter', String('hello'))
        for path, words in ((cut, 'rosbag reindex'), (text, 'text.bag: is not a bag'),
                            (empty, 'empty.bag: is not a bag'), ('/nowhere.bag', 'nowhere.bag: there is no such file'),
                            (foreign, 'holds no message of an emulator'),
                            (self.directory, '%s: is a directory' % self.directory)):
            self.assert_reported(UNCHECKED, words, path=path)
            answer = checks.bag_check(path, self.good)
            self.assertEqual(answer.code, UNCHECKED, path)
            self.assertIn('bag_check: %s: ' % path, answer.text)
            self.assertIn('SOUND', answer.text)  # the other is checked
        answer = checks.replay_check(self.good, foreign)
        self.assertEqual(answer.code, SOUND, answer.text)
        self.assertIn('foreign.bag: holds no message of an emulator', answer.text)
        subprocess.run(['rosbag', 'reindex', '--force', str(cut)], check=True, stdout=subprocess.DEVNULL)
        self.assert_reported(SOUND, 'IDENTICAL', sound=True, path=cut)

    def test_a_damaged_chunk(self):
        """rosbag has then unpacked half of it into the memory of another one, and what stands there is spoiled."""
        path = self.write(compression='lz4', chunk_threshold=100000)
        with rosbag.Bag(str(path)) as bag:
            begins = sorted(chunk.pos for chunk in bag._chunks)
        data = path.read_bytes()
        for begin, end in zip(begins[1:], begins[2:]):
            damaged, middle = bytearray(data), (begin + end) // 2
            damaged[middle:middle + 16] = (byte ^ 0xa5 for byte in damaged[middle:middle + 16])
            path.write_bytes(damaged)
            self.assert_reported(UNCHECKED, 'CANNOT BE CHECKED: ROSLZ4', path=path)

    def test_more_bags_than_files_may_be_open(self):
        """Of a recording that was split every minute. The limit that can be raised is; of the other one it tells."""
        bags = [self.write()] * 40

        def check(hard):
            done = subprocess.run([find('replay_check'), *map(str, bags)], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, universal_newlines=True,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (32, hard)))
            return checks.Answer(done.returncode, done.stdout)
        answer = check(100)
        self.assertEqual((answer.code, answer.text.count('IDENTICAL')), (SOUND, len(bags)), answer.text)
        answer = check(32)
        self.assertEqual(answer.code, UNCHECKED, answer.text)
        self.assertIn('40 bags: only 32 files may be open at once; raise the limit (ulimit -n)', answer.text)

    def test_wrong_arguments(self):
        self.assertEqual(checks.replay_check().code, USAGE)
        self.assertEqual(checks.bag_check().code, USAGE)
        self.assertEqual(checks.bag_check('--frobnicate', self.good).code, USAGE)
        self.assertEqual(checks.bag_check('--help').code, 0)

    def test_a_damaged_definition_of_a_message(self):
        """Its md5sum says that it is ours."""
        data, path = self.good.read_bytes(), self.directory / 'damaged.bag'
        path.write_bytes(data.replace(b'ModelTime time', b'ModelTime tim='))
        self.assertNotEqual(path.read_bytes(), data)
        answer = checks.bag_check(path)
        self.assertEqual(answer.code, SOUND, answer.text)

    def test_interrupted(self):
        with mock.patch('rosbag.Bag', side_effect=KeyboardInterrupt):
            answer = checks.bag_check(self.good)
        self.assertEqual((answer.code, answer.text), (130, ''))

    def test_a_part_is_forgotten(self):
        latched = [copy.copy(entry) for entry in self.entries[:3]]
        latched[2].stamp += genpy.Duration(0, 1)  # a part by the node has a snapshot of its own
        ends = [self.entries.index(self.of('friction')[batch]) + 1 for batch in (39, 59)]
        everything = self.entries
        parts = []
        for name, entries in (('run.bag', everything[:ends[0]]), ('run_001.bag', latched + everything[ends[0]:ends[1]]),
                              ('run_002.bag', latched + everything[ends[1]:])):
            self.entries = entries
            parts.append(self.write(name))
        def without_friction(part):
            """As by rosbag filter: bag_to_csv called these parts of another recording."""
            path = self.directory / 'filtered' / part.name
            path.parent.mkdir(exist_ok=True)
            with rosbag.Bag(str(part)) as bag, rosbag.Bag(str(path), 'w') as filtered:
                for topic, raw, stamp, header in bag.read_messages(raw=True, return_connection_header=True):
                    if not topic.endswith('friction'):
                        filtered.write(topic, raw, stamp, raw=True, connection_header=header)
            return path
        answer = checks.call('bag_to_csv', '--topic', 'impacts', *map(without_friction, parts))
        self.assertEqual(answer.code, SOUND, answer.text[-300:])
        self.assertIn('what is missing at its ends is not known', answer.text)
        for paths in (parts, parts[::-1]):  # a shell may list them in another order
            self.assertEqual(checks.bag_check(*paths).code, SOUND)
            self.assertEqual(checks.replay_check(*paths).code, SOUND)
        others = [self.directory / name for name in ('run_003.bag', 'run_20261128.bag')]  # names that users choose
        for part, other in zip((parts[0], parts[2]), others):
            other.write_bytes(part.read_bytes())
        self.assertEqual(checks.bag_check(*others).code, SOUND)
        answer = checks.replay_check(parts[0], '%s/./%s' % (self.directory, parts[2].name))  # another spelling
        self.assertEqual(answer.code, UNCHECKED, answer.text)
        named = parts[2].rename(parts[2].with_name('run_002.bag.active'))  # as one that was killed and indexed again
        answer = checks.bag_check(parts[0], '%s/./%s' % (self.directory, named.name))
        self.assertEqual(answer.code, DIFFERS, answer.text)
        self.assertIn('%s does not go on where run.bag ends: 20 batches between them are missing' % named.name,
                      answer.text)
        for entry, change in ((everything[ends[0] + 5], {'epoch': 7}), (latched[0], {'restitution_gamma': 0.5})):
            altered = copy.copy(entry)
            altered.edit(**change)
            self.entries = latched + everything[ends[0]:ends[1]] + [altered]
            answer = checks.bag_check(parts[0], self.write('run_001.bag'))
            self.assertEqual(answer.code, DIFFERS, answer.text)
            self.assertIn('1 numbers of %s are those of two messages' % type(entry.message()).__name__, answer.text)

    def test_the_worse_of_two_recordings_decides(self):
        self.of('friction')[30].edit(k_f=1.0)
        both = self.write('bad.bag'), self.good
        for paths in (both, both[::-1]):
            answer = checks.replay_check(*paths)
            self.assertEqual(answer.code, DIFFERS, answer.text)
            self.assertEqual(answer.text.count('IDENTICAL'), 1, answer.text)

    def test_latched_messages_come_again(self):
        """The parts of a split recording merged, or played and recorded again, or rosbag record repeats the first."""
        for at in self.entries.index(self.of('friction')[39]) + 1, len(self.entries) - 1:
            again = [copy.copy(entry) for entry in self.entries[:3]]
            for entry in again:
                entry.stamp = self.entries[at].stamp
            self.entries[at:at] = again
        self.assert_reported(SOUND, 'IDENTICAL', sound=True, path=self.write('merged.bag'))

    def test_messages_stand_in_any_order_in_the_file(self):
        """rosbag gives those of a topic in this order, not in that of their times."""
        self.entries.reverse()
        path = self.write()
        self.assert_reported(SOUND, 'IDENTICAL', sound=True, path=path)
        checks.simulated_by_python(path)

    def test_physics_alone_tells(self):
        """bag_check knows what a mean and an energy balance are, and does not call it physics where messages lack."""
        def scale(topic, begin, **factors):
            for entry in self.of(topic)[begin:]:
                message = entry.message()
                entry.edit(**{name: getattr(message, name) * factor for name, factor in factors.items()})
        def start_again():  # with the stamps of the first start, as on the clock
            length = self.entries[-1].stamp - self.entries[0].stamp + genpy.Duration(1)
            again = copy.deepcopy(self.entries)
            for entry in again:
                entry.stamp += length
            self.entries += again
        def record_by_rosbag():  # which hears of one topic later than of another
            snapshot, = self.of('snapshot')
            snapshot.stamp += genpy.Duration(0, 1000)
            self.remove(*self.of('impacts')[:2], *self.of('deflection')[-3:])
        def miss_work(samples_s=None):
            for entry in self.of('deflection') if samples_s else ():
                entry.edit(sample_period=samples_s)
            scale('friction', 60, mean_lateral_force=1.1, k_f_work=1.1)
        nan = [float('nan')] * len(self.of('deflection')[5].message().vertical)
        for subject, spoil in ((None, lambda: None),
                               ('samples', lambda: self.of('deflection')[5].edit(vertical=nan)),
                               ('samples', lambda: self.of('deflection')[5].edit(vertical=[-1e-9] * len(nan))),
                               (None, lambda: (self.of('deflection')[5].edit(vertical=[-1e-9] * len(nan)),
                                               self.remove(*self.of('applied')))),
                               (None, record_by_rosbag),
                               (None, start_again),
                               (None, lambda: miss_work(samples_s=2e-4)),  # between them the springs may hold more
                               (None, lambda: (self.of('snapshot')[0].edit(u=1e3), miss_work())),  # it was so fast
                               (None, self.end_at_the_last_deflection),
                               ('complete', lambda: self.remove(*self.of('deflection')[:5])),
                               ('complete', lambda: self.remove(*self.of('impacts')[-5:])),
                               ('complete', lambda: self.remove(*self.of('friction')[-5:])),
                               ('complete', lambda: self.remove(*self.of('applied')[-1:])),
                               ('complete', lambda: self.remove(*self.batches(slice(100, 110)))),
                               ('complete', lambda: self.of('friction')[-1].edit(drag_velocity=1e200)),
                               ('complete', lambda: self.of('friction')[-1].edit(epoch=7)),
                               ('energy', lambda: self.of('deflection')[5].edit(
                                   vertical=[1e200] * len(self.of('deflection')[5].message().vertical))),
                               ('energy', lambda: self.of('friction')[-1].edit(heat_to_bath=float('nan'))),
                               ('K_f', lambda: scale('friction', 60, energy_loss=1 + 1e-8, k_f=1 + 1e-8)),
                               ('K_f', lambda: scale('friction', 60, k_f=1 + 1e-8)),
                               ('K_f', lambda: scale('friction', 60, k_f_work=1 + 1e-8)),
                               ('energy', miss_work),
                               ('complete', lambda: [e.edit(first_sample=e.message().first_sample + 1)
                                                     for e in self.of('deflection')[50:]]),
                               ('counters', lambda: self.of('status')[0].edit(worst_penetration=1e-18)),
                               ('counters', lambda: self.of('status')[0].edit(search_failures=1))):  # a reset follows
            with self.subTest(subject=subject):
                self.setUp()
                spoil()
                answer = checks.bag_check(self.write())
                bad = {line.split()[1] for line in answer.text.splitlines() if line.startswith('  BAD')}
                self.assertEqual((bad, answer.code), ({subject} - {None}, DIFFERS if subject else SOUND), answer.text)

#!/usr/bin/python3
"""A recording of which something is missing or out of order, a broken file, or none at all: each is reported by its exit code,
in words."""
import subprocess

import rosbag
from std_msgs.msg import String

import checks
from emulator_under_test import run
from spoiled_bag import SpoiledBag


class BrokenBags(SpoiledBag):
    def test_a_message_is_missing(self):
        for topic in ('deflection', 'impacts', 'friction', 'applied_drag', 'status'):
            self.setUp()
            self.remove(self.of(topic)[1])
            self.assert_reported(checks.MISSING, 'holds')  # the closing mark counts

    def test_a_message_is_missing_and_nobody_counts(self):
        marks = self.of('recording')
        for topic in ('deflection', 'impacts', 'friction'):
            self.setUp()
            self.remove(self.of(topic)[100], *self.of('recording'))
            self.assert_reported(checks.MISSING, 'MISSING', 'before batch 101')
        self.assertEqual(len(marks), 2)

    def test_the_first_command_is_missing(self):
        self.remove(self.of('applied_drag')[0], *self.of('recording'))
        self.assert_reported(checks.MISSING, 'history of commands')

    def test_the_end_is_missing(self):
        del self.entries[len(self.entries) // 2:]
        self.assert_reported(checks.TRUNCATED, 'IDENTICAL as far as it goes')
        self.assertEqual(checks.replay_check(self.write(), '--open-end').code, checks.SOUND)

    def test_a_batch_that_was_never_published(self):
        """As on a machine too busy to publish: the numbers of the messages run on, those of samples do not."""
        self.remove_digests()
        lost = [self.of(topic)[100] for topic in ('deflection', 'impacts', 'friction')]
        self.remove(*lost)
        for entry in self.entries:
            message = entry.message()
            if entry.topic in ('deflection', 'impacts', 'friction') and message.header.seq > 100:
                message.header.seq -= 1
                entry.put(message)
        mark = self.of('recording')[-1]
        mark.edit(messages=mark.message().messages - 3)
        self.assert_reported(checks.MISSING, 'MISSING: 3 messages', 'never published', 'before batch 100')

    def test_reordered(self):
        first, second = self.of('deflection')[100:102]
        first.raw, second.raw = second.raw, first.raw
        self.assert_reported(checks.REORDERED, 'order')

    def test_cut_off(self):
        path = self.directory / 'cut.bag'
        data = self.good.read_bytes()
        for length in (len(data) * 2 // 3, len(data) - 100, 5000, 20):
            path.write_bytes(data[:length])
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, checks.TRUNCATED, '%d bytes: %s' % (length, answer.text))
            self.assertIn('rosbag reindex', answer.text)
            self.assertNotEqual(checks.bag_check(path).code, 0)

    def test_two_in_one_file(self):
        path = self.directory / 'joined.bag'
        path.write_bytes(2 * self.good.read_bytes())
        for answer in (checks.replay_check(path), checks.bag_check(path)):
            self.assertEqual(answer.code, checks.ALTERED, answer.text)
            self.assertIn('%d bytes behind its end' % self.good.stat().st_size, answer.text)

    def test_damaged(self):
        """A length in the index that leads out of the file: rosbag's reader falls over it, our tools tell."""
        data = bytearray(self.good.read_bytes())
        index = data.rindex(b'count=')
        data[index - 22:index - 18] = b'\xff\xff\xff\x7f'
        for place in range(index - 4000, index, 400):
            damaged = bytearray(data)
            damaged[place] ^= 0x40
            path = self.directory / 'damaged.bag'
            path.write_bytes(damaged)
            for answer in (checks.replay_check(path), checks.bag_check(path)):
                self.assertIn(answer.code, range(8), answer.text)
                self.assertTrue(answer.text)

    def test_reindexed(self):
        path = self.directory / 'reindexed.bag'
        data = self.good.read_bytes()
        for length, code, words in ((len(data), checks.SOUND, 'IDENTICAL\n'),
                                    (len(data) // 2, checks.TRUNCATED, 'IDENTICAL as far as it goes')):
            path.write_bytes(data[:length])
            subprocess.run(['rosbag', 'reindex', '--force', str(path)], check=True, stdout=subprocess.DEVNULL)
            answer = checks.replay_check(path)
            self.assertEqual(answer.code, code, answer.text)
            self.assertIn(words, answer.text)

    def test_foreign(self):
        path = self.directory / 'foreign.bag'
        with rosbag.Bag(str(path), 'w') as bag:
            bag.write('/chatter', String('hello'))
        text, empty = self.directory / 'text.bag', self.directory / 'empty.bag'
        text.write_text('not a bag')
        empty.touch()
        for spoiled, words in ((path, 'no configuration'), (text, 'not a ROS bag'), (empty, 'is empty'),
                               ('/nowhere.bag', 'opened'), (self.directory, 'is a directory')):
            answer = checks.replay_check(spoiled)
            self.assertEqual(answer.code, checks.FOREIGN, answer.text)
            self.assertIn(words, answer.text)
            self.assertNotEqual(checks.bag_check(spoiled).code, 0)

    def test_other_definitions_of_messages(self):
        for entry in self.of('friction'):
            entry.raw = entry.raw[:2] + ('0' * 32,) + entry.raw[3:]
            entry.header = dict(entry.header, md5sum='0' * 32)
        self.assert_reported(checks.FOREIGN, 'another version')

    def test_wrong_arguments(self):
        self.assertEqual(checks.replay_check().code, checks.USAGE)
        self.assertEqual(checks.replay_check('--frobnicate', self.good).code, checks.USAGE)
        self.assertEqual(checks.replay_check('--help').code, 0)


if __name__ == '__main__':
    run(BrokenBags)

#!/usr/bin/python3
"""What has to be built for some tests: reads `ctest --show-only=json-v1`, prints targets of Ninja.

usage: needed_by_tests.py OUTPUTS < TESTS      OUTPUTS: a file with the answer to `ninja -t targets all`
"""
import json
import os
import re
import sys


def labels(test):
    return [label for p in test['properties'] if p['name'] == 'LABELS' for label in p['value']]


def needs(test, outputs):
    # ctest leaves out the command of a program that is not built yet: its target has the name of the test behind a
    # prefix
    words = re.split(r'[\s"=]+', ' '.join(test.get('command', ['afm_' + test['name'], 'afm_replay_' + test['name']])))
    if '_rostest_' in test['name']:
        return ({'afm_emulator', 'afm_client_calls', 'afm_disturbances', 'afm_examples_ros', 'afm_bag_to_csv'} |
                ({'afm_python'} & outputs))
    if 'docs' in labels(test):
        return {'afm_python', 'afm_emulator_generate_messages_py'} & outputs
    if 'node' in labels(test) or any(os.path.isdir(word) and word.endswith('lib/afm_emulator') for word in words):
        return {'all'}  # runs what it likes
    built = {name for word in words for name in (word, os.path.relpath(word)) if name in outputs}
    if test['name'] == 'consumer':
        built.add('all')  # which it installs
    in_ros = any(word.endswith('env_cached.sh') for word in words)
    return built or ({'afm_emulator'} if in_ros else set())


def main(path):
    with open(path) as lines:
        outputs = {line.rsplit(':', 1)[0] for line in lines}
    tests = json.load(sys.stdin)['tests']
    print(*sorted(set().union(*(needs(test, outputs) for test in tests))))


if __name__ == '__main__':
    main(sys.argv[1])

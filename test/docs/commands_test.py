#!/usr/bin/env python3
"""Every command in README.md and docs/*.md runs as it stands there, but for what command_tables.py shortens or leaves
out.

Usage: commands_test.py ROOT BUILD PREFIX     (BUILD: of ROOT; PREFIX: its devel space)
"""
import re
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from command_tables import NOT_RUN, SUBSTITUTIONS
from reader import Reader

SKIPPED = 77
DOCUMENTS_AT_A_TIME = 3  # on two cores: much of the time is spent waiting for roslaunch


class Tables:
    """What is substituted and left out, and which entries were used."""

    def __init__(self):
        self.lock, self.used = threading.Lock(), set()

    def reason_not_to_run(self, text):
        return next((self.note(pattern, reason) for pattern, reason in NOT_RUN if re.search(pattern, text)), None)

    def shortened(self, text):
        for pattern, replacement in SUBSTITUTIONS:
            text, count = re.subn(pattern, replacement, text)
            if count:
                self.note(pattern)
        return text

    def note(self, pattern, result=None):
        with self.lock:
            self.used.add(pattern)
        return result

    def unused(self):
        return ['command_tables.py: no document uses %s' % pattern for pattern, _ in SUBSTITUTIONS + NOT_RUN
                if pattern not in self.used]


def blocks_of_commands(path):
    return path.read_text().count('```bash')


def main(root, build, prefix):
    root, build, prefix = (Path(path).resolve() for path in (root, build, prefix))
    if not (prefix / 'lib/afm_emulator/friction_curve').exists():
        print('nothing is built in %s: run scripts/build' % prefix)
        return SKIPPED
    if (build, prefix) != (root / 'build', root / 'devel') and prefix != build / 'devel':
        print('%s is not where scripts/build builds: its commands would build once more' % prefix)
        return SKIPPED
    reader = Reader(root, build, prefix, Tables())
    documents = sorted([root / 'README.md', *(root / 'docs').glob('*.md')], key=blocks_of_commands, reverse=True)
    with ThreadPoolExecutor(DOCUMENTS_AT_A_TIME) as pool:
        list(pool.map(reader.read, documents))  # the longest first: at the end none goes on alone
    faults = reader.faults + reader.tables.unused()
    print('%d faults' % len(faults))  # first, as what follows is long
    for fault in faults:
        print('FAULT: ' + fault)
    print('\n'.join(reader.report))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))

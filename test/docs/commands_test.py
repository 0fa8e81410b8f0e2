#!/usr/bin/env python3
"""Every command in README.md and docs/*.md runs as it stands there, but for what command_tables.py shortens or leaves out.

Usage: commands_test.py ROOT BUILD PREFIX [MPIRUN]     (BUILD: of ROOT; PREFIX: where it is installed; MPIRUN: if built with MPI)
"""
import re
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from command_tables import NOT_RUN, OPTIONAL, SUBSTITUTIONS
from documents import Document, Fault, options, without_comments
from shell import Shell

SKIPPED = 77
DOCUMENTS_AT_A_TIME = 3  # on two cores: much of the time is spent waiting for roslaunch
NEEDS_EMULATOR = re.compile(r'\b(rostopic|rosservice|dynparam|emulator:=)')
OWN_MASTER = re.compile(r'\broslaunch afm_emulator (?!view)|scripts/(run|plot_scenes)|benchmark/')
BUILDS = re.compile(r'scripts/(run|build)')
# for ROS's scripts end with 0 where they have not found something
BAD_NEWS = re.compile(r"\bERROR\b|^(\S+: )?[Ee]rror:|[Cc]ouldn't find|command not found|No such file|Traceback|process has died", re.M)
PROGRAM = re.compile(r'(rosrun afm_emulator |build/devel/lib/afm_emulator/|(?=scripts/|benchmark/))([a-z][\w./]+)')


class Tables:
    """What is substituted and left out, and which entries were used."""

    def __init__(self, mpirun):
        self.lock, self.used = threading.Lock(), set()
        self.not_run = NOT_RUN + ([] if mpirun else [(r'^mpirun', 'built without MPI')])

    def reason_not_to_run(self, text):
        return next((self.note(pattern, reason) for pattern, reason in self.not_run if re.search(pattern, text)), None)

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
        return ['command_tables.py: no document uses %s' % pattern for pattern, _ in SUBSTITUTIONS + self.not_run
                if pattern not in self.used]


class Reader:
    """Pastes the commands of one document after another into a shell."""
    building = threading.Lock()  # two builds of one directory would disturb each other

    def __init__(self, root, build, prefix, tables):
        self.root, self.build, self.prefix, self.tables, self.faults = root, build, prefix, tables, []
        programs = [p.name for d in (prefix, build / 'devel') for p in (d / 'lib/afm_emulator').iterdir()]
        self.tools = sorted({name for name in programs if re.fullmatch(r'\w+', name)})

    def read(self, path):
        try:
            document = Document(path, self.root)
            self.faults += document.faults(self.tools)
            commands = list(document.commands())
        except Fault as fault:
            self.faults.append(str(fault))
            return
        shell = Shell(self.root, self.build, self.prefix)
        try:
            self.follow(shell, document, commands)
        finally:
            shell.close()

    def follow(self, shell, document, commands):
        if any(NEEDS_EMULATOR.search(command.text) for command in commands):
            shell.start_emulator()
        if '/run.bag' in document.text and 'start_recording' not in document.text:
            self.record(shell)
        for command in commands:
            self.paste(shell, command)
        for span in document.spans():
            if PROGRAM.match(span.text):
                self.check_options(shell, span)
        if shell.emulator and not shell.is_emulator_alive():
            self.faults.append('%s: the emulator is not alive at the end: %s' % (
                document.name, (shell.directory / 'emulator.log').read_text()[-2000:]))

    def record(self, shell):
        """The recording that documents call run.bag, where they do not make it themselves."""
        shell.run('rosservice call /afm/start_recording "name: \'run\'" && rosservice call /afm/stop_recording')

    def paste(self, shell, command):
        name = PROGRAM.search(command.text)
        missing = name and OPTIONAL.get(name.group(2))
        if missing and not (self.build / 'devel/lib/afm_emulator' / name.group(2)).exists():
            print('%s: not built, without %s: %s' % (command.place, missing, command.text))
            return
        reason = self.tables.reason_not_to_run(command.text)
        if reason:
            print('%s: not run, %s: %s' % (command.place, reason, command.text))
            self.check_options(shell, command)
            return
        begin, text = time.monotonic(), self.tables.shortened(without_comments(command.text))
        if BUILDS.search(text):
            with self.building:
                output, code = shell.run(text, own_master=True)
        else:
            output, code = shell.run(text, own_master=bool(OWN_MASTER.search(text)))
        print('%s: %.1f s: %s' % (command.place, time.monotonic() - begin, text), flush=True)
        if code != 0 or BAD_NEWS.search(output):
            self.faults.append('%s: ends with %d: %s\nrun as: %s\n%s' % (command.place, code, command.text, text, output[-3000:]))

    def check_options(self, shell, command):
        """That the help of our own tools knows the options of a command that is not run."""
        program, used = PROGRAM.search(command.text), options(command.text)
        launch = re.search(r'roslaunch afm_emulator \w+\.launch', command.text)
        if not (used and (program or launch)):
            return
        output, code = shell.run(launch.group().replace('roslaunch', 'roslaunch --ros-args') if launch else
                                 program.group() + ' --help')
        for option in used:
            if code != 0 or not re.search(r'(?<![\w-])%s(?![\w-])' % re.escape(option), output):
                self.faults.append('%s: no %s in the help: %s\n%s' % (command.place, option, command.text, output))


def main(root, build, prefix, mpirun=''):
    root, build, prefix = (Path(path).resolve() for path in (root, build, prefix))
    if not (prefix / 'lib/afm_emulator/friction_curve').exists():
        print('nothing is installed in %s: run scripts/build or scripts/test' % prefix)
        return SKIPPED
    if (build, prefix) != (root / 'build', root / 'install') and prefix != build / 'install':
        print('%s is not where scripts/build installs: its commands would build once more' % prefix)
        return SKIPPED
    reader = Reader(root, build, prefix, Tables(mpirun))
    with ThreadPoolExecutor(DOCUMENTS_AT_A_TIME) as pool:
        list(pool.map(reader.read, [root / 'README.md'] + sorted((root / 'docs').glob('*.md'))))
    faults = reader.faults + reader.tables.unused()
    for fault in faults:
        print('FAULT: ' + fault)
    print('%d faults' % len(faults))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))

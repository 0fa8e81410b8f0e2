"""Pastes the commands of a document into a shell, and keeps what goes wrong."""
import functools
import re
import threading
import time

from command_tables import OPTIONAL
from documents import Document, Fault, options, without_comments
from shell import Shell

NEEDS_EMULATOR = re.compile(r'\b(rostopic|rosservice|dynparam|emulator:=)')
OWN_MASTER = re.compile(r'\broslaunch afm_emulator (?!view)|scripts/run|benchmark/')
BUILDS = re.compile(r'scripts/(run|build)')
# what stands in several documents and does the same in each
ONCE = re.compile(r'scripts/(run|build|install_dependencies)|^until_interrupted')
# for ROS's scripts end with 0 where they have not found something
BAD_NEWS = re.compile(r"\bERROR\b|^(\S+: )?[Ee]rror:|[Cc]ouldn't find|command not found|No such file|Traceback|"
                      r"process has died", re.M)
# what the ROS of Debian 11 prints at its end (docs/platforms.md)
OLD_THREADS = re.compile(r"Traceback \(most recent call last\):\n(?:  .*\n)+"
                         r"AttributeError: '\w+' object has no attribute 'isAlive'")
# what rosrun, which looks through the whole tree, says where another test has just removed something
VANISHED = re.compile(r"^find: .*: No such file or directory\n", re.M)
# what roscpp says where a node of another test still asks a dead one by HTTP, whose port it has got from the system
FOREIGN = re.compile(r"^.*a header of over a gigabyte was predicted in tcpros.*\n", re.M)
NOISE = (OLD_THREADS, VANISHED, FOREIGN)
PROGRAM = re.compile(r'(rosrun afm_emulator |build/test/|(?=scripts/|benchmark/))([a-z][\w./]+)')


class Reader:
    """Pastes the commands of one document after another into a shell."""
    building = threading.Lock()  # two builds of one directory would disturb each other

    def __init__(self, root, build, prefix, tables):
        self.root, self.build, self.prefix, self.tables = root, build, prefix, tables
        self.faults, self.report, self.done = [], [], set()
        programs = [p.name for p in (prefix / 'lib/afm_emulator').iterdir()]
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
        reason = self.tables.reason_not_to_run(command.text)
        if reason:
            self.report.append('%s: not run, %s: %s' % (command.place, reason, command.text))
            self.check_options(shell, command)
            return
        begin, text = time.monotonic(), self.tables.shortened(without_comments(command.text))
        if ONCE.search(text):
            if text in self.done:
                self.report.append('%s: run already, for another document: %s' % (command.place, command.text))
                return
            self.done.add(text)
        missing = self.missing_here(text)
        if missing:
            self.report.append('%s: not run, built without %s: %s' % (command.place, missing, command.text))
            return
        if BUILDS.search(text):
            with self.building:
                output, code = shell.run(text, own_master=True)
        else:
            output, code = shell.run(text, own_master=bool(OWN_MASTER.search(text)))
        self.report.append('%s: %.1f s: %s' % (command.place, time.monotonic() - begin, text))
        told = functools.reduce(lambda text, noise: noise.sub('', text), NOISE, output)
        if code != 0 or BAD_NEWS.search(told):
            self.faults.append('%s: ends with %d: %s\nrun as: %s\n%s' %
                               (command.place, code, command.text, text, output[-3000:]))

    def missing_here(self, text):
        """What the machine lacks that the command needs."""
        program = PROGRAM.search(text)
        if program and not (self.prefix / 'lib/afm_emulator' / program.group(2)).exists():
            return OPTIONAL.get(program.group(2))
        return None

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

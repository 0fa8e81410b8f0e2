"""Reads the commands out of README.md and docs/*.md: a command stands in a ```bash block, alone or with others."""
import re
import shlex
import subprocess
from collections import namedtuple

Command = namedtuple('Command', 'place text')  # place: DOCUMENT:LINE, of the first line
FENCE = re.compile(r'^```(\w*)')
SPAN = re.compile(r'`([^`]+)`')
# what a line of a command begins with, if it stands outside a bash block
BEGINNING = re.compile(r'(scripts/\w|benchmark/\w|build/\w|rosrun |roslaunch |rostopic |rosservice |rosbag |source |'
                       r'snakemake )')


class Fault(Exception):
    """What is wrong with a document, after its place."""


def is_whole(text):
    """bash decides: a loop without its end and a pipe without its right side are not whole."""
    return not text.endswith('\\') and subprocess.run(['bash', '-n', '-c', text],
                                                      stderr=subprocess.DEVNULL).returncode == 0


def without_comments(text):
    return '\n'.join(re.sub(r'(^|\s)#.*', '', line) for line in text.splitlines()).strip()


class Document:
    def __init__(self, path, root):
        self.name = str(path.relative_to(root))
        self.text = path.read_text(encoding='utf-8')
        self.bash, self.other, self.prose = [], [], []  # lines with their numbers
        inside = None
        for number, line in enumerate(self.text.splitlines(), 1):
            fence = FENCE.match(line)
            if fence:
                inside = None if inside is not None else fence.group(1)
                self.bash.append((number, None))  # no command goes on in the next block
            elif inside is None and not line.startswith('    '):
                self.prose.append((number, line))
            else:
                (self.bash if inside == 'bash' else self.other).append((number, line))
        if inside is not None:
            raise Fault('%s: a block without its end' % self.name)

    def place(self, number):
        return '%s:%d' % (self.name, number)

    def commands(self):
        begin, text = 0, ''
        for number, line in self.bash:
            if line is None:
                if text:
                    raise Fault('%s: not a whole command: %s' % (self.place(begin), text))
                continue
            if not text:
                begin = number
            text = text + '\n' + line if text else line
            if not without_comments(text):
                text = ''
            elif is_whole(text):
                yield Command(self.place(begin), text)
                text = ''

    def spans(self):
        """What stands between single backticks; a span may go on in the next line."""
        text = '\n'.join(line for _, line in self.prose)
        numbers = [number for number, _ in self.prose]
        for span in SPAN.finditer(text):
            yield Command(self.place(numbers[text.count('\n', 0, span.start())]), ' '.join(span.group(1).split()))

    def faults(self, tools):
        """What a reader could not paste."""
        bare = re.compile(r'(?<![\w/.:=-])(?<!rosrun afm_emulator )(%s)(?![\w/.=:-])' % '|'.join(tools))
        for number, line in self.other:
            if BEGINNING.match(line.strip()) or re.match(r'(%s) -' % '|'.join(tools), line.strip()):
                yield '%s: a command outside a bash block: %s' % (self.place(number), line.strip())
        for number, line in enumerate(self.text.splitlines(), 1):
            if 'build/devel' in line or 'install/setup.bash' in line:
                yield '%s: build/devel or install/setup.bash: what is sourced is devel/setup.bash' % self.place(number)
        for command in self.commands():
            if command.text.startswith('snakemake'):  # its rules have the names of tools
                continue
            for name in bare.findall(without_comments(command.text)):
                yield '%s: %s by its bare name: %s' % (command.place, name, command.text)
        for span in self.spans():
            if re.match(r'(%s) [^=]' % '|'.join(tools), span.text):
                yield '%s: a tool by its bare name: %s' % span


def options(text):
    """The --options of a command, without those of the commands that it is given as an argument, and NAME:= of
    roslaunch."""
    words = shlex.split(without_comments(text).replace('\\\n', ' '))
    return [word.split('=')[0] for word in words if re.match(r'--[a-z]', word)] + [
        word.split(':=')[0] for word in words if re.match(r'\w+:=', word)]

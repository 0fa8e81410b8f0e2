"""Runs the parts: commands into files of the build directory, results into docs/data, what is done into a ledger."""
import json
import subprocess
import sys
import time

from . import programs
from .provenance import code_key, stamp
from .results import Publisher


class Ledger:
    """The parts that are done on each state of the code, and how long they took."""

    def __init__(self, path):
        self.path, self.key = path, code_key()
        self.all = json.loads(path.read_text()) if path.exists() else {}
        self.done = self.all.setdefault("done", {}).setdefault(self.key, {})
        self.took = self.all.setdefault("minutes", {})

    def is_done(self, name, mode):
        return self.done.get(name) in (mode, "full")

    def minutes(self, part, mode):
        return self.took.get(part.name + " " + mode, part.minutes[mode == "full"])

    def note(self, name, mode, minutes):
        self.done[name] = mode
        self.took[name + " " + mode] = minutes
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps(self.all, indent=1))


class Run:
    def __init__(self, data, mode):
        self.data, self.mode, self.stamp = data, mode, stamp(mode)

    def measure(self, part, left):
        """None, or why it failed."""
        scratch = programs.build_directory() / "qualify" / part.name
        scratch.mkdir(parents=True, exist_ok=True)
        outputs, fault = [], None
        for i, command in enumerate(part.full if self.mode == "full" else part.quick):
            output = scratch / ("output_%d.txt" % i)
            code = self.run(command.replace("SCRATCH", str(scratch)), output, left)
            outputs.append((command, output.read_text(errors="replace"), code))
            if code != 0:
                fault = "%s ends with %d: %s" % (command, code, output)
        if fault and not part.keeps_failures:
            return fault
        part.keep(Publisher(self.data, scratch, self.stamp), outputs)
        return fault

    @staticmethod
    def run(command, output, left):
        program = programs.program_of(command)
        line = command.replace(program, str(programs.locate(program)), 1)
        begin = time.monotonic()
        with open(str(output), "w") as file, open(str(output.with_suffix(".errors")), "w") as errors:
            running = subprocess.Popen(["bash", "-c", line], cwd=str(programs.ROOT), stdin=subprocess.DEVNULL, stdout=file, stderr=errors)
            try:
                while running.poll() is None:
                    time.sleep(1.0)
                    spent = (time.monotonic() - begin) / 60.0
                    if sys.stdout.isatty():
                        text = "%s: %.1f min, about %.0f min left in all" % (command[:60], spent, max(0.0, left(spent)))
                        print("\r\033[K    " + text, end="", flush=True)
            finally:
                if running.poll() is None:
                    running.terminate()
                    running.wait()
        if sys.stdout.isatty():
            print("\r\033[K", end="")
        return running.returncode

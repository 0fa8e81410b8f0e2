"""The package's command-line tools, and the tables they make."""
import csv
import os
import subprocess
import sys
import time
from pathlib import Path

TOOLS = Path(os.environ.get("AFM_BUILD_DIR", Path(__file__).resolve().parent.parent.parent)) / "devel/lib/afm_emulator"


def numbers(row):
    """The fields of a row as numbers where they are numbers."""
    result = {}
    for key, text in row.items():
        try:
            result[key] = float(text)
        except ValueError:
            result[key] = text
    return result


def read(path):
    with open(str(path)) as file:
        return [numbers(row) for row in csv.DictReader(file)]


class Tables:
    def __init__(self, directory, keep, quick):
        self.directory, self.keep, self.quick = directory, keep, quick
        self.made = set()  # by this run: two figures may need one table
        directory.mkdir(parents=True, exist_ok=True)

    def make(self, name, tool, *arguments):
        """The rows of the tool's table, kept in the directory as NAME.csv, with the command that made it in NAME.command."""
        path, made_by = self.directory / (name + ".csv"), self.directory / (name + ".command")
        command = " ".join(str(word) for word in (tool,) + arguments)
        may_be_used = self.keep or name in self.made
        if not (may_be_used and path.exists() and made_by.exists() and made_by.read_text() == command):
            path.unlink(missing_ok=True)
            made_by.write_text(command)
            begin, part = time.time(), self.directory / (name + ".part")
            with open(str(part), "w") as file:
                self.run(file, tool, *arguments)
            self.times(name).write_text("%g\n" % (time.time() - begin))
            part.replace(path)
        self.made.add(name)
        return read(path)

    def times(self, name):
        return self.directory / (name + ".seconds")

    def seconds(self, name):
        """How long the tool took for this table."""
        return float(self.times(name).read_text())

    def write(self, name, header, rows):
        """A table worked out from others."""
        with open(str(self.directory / (name + ".csv")), "w") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(["%.6g" % field if isinstance(field, float) else field for field in row] for row in rows)
        self.made.add(name)

    def side_table(self, name):
        """Where a tool writes a second table."""
        self.made.add(name)
        return self.directory / (name + ".csv")

    @staticmethod
    def run(file, tool, *arguments):
        command = [str(TOOLS / tool)] + [str(argument) for argument in arguments]
        print("      " + " ".join([tool] + command[1:]), flush=True)
        try:
            subprocess.run(command, stdout=file, check=True)
        except FileNotFoundError:
            sys.exit("figures: no %s: run scripts/build first" % command[0])
        except subprocess.CalledProcessError:
            sys.exit("figures: %s failed" % tool)  # it has said why

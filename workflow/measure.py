#!/usr/bin/python3
"""Runs a command of the laboratory into a table, and writes above it where it comes from: the command, the commit, the
processor, the date, and how long it took. Tables that the command writes by itself get the same line.

Usage: measure.py MODE MAY_FAIL TABLE SIDE_TABLE... -- COMMAND      (MAY_FAIL: 1, and a failure is a result too)
"""
import os
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NOT_CODE = ("docs", "README.md", "CHANGELOG.rst", "CONTRIBUTING.md",
            "LICENSE")  # what a document says changes no measurement


def git(*arguments):
    done = subprocess.run(("git", "-C", str(ROOT)) + arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          universal_newlines=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def commit():
    changed = git("status", "--porcelain", "--", ".", *(":!" + name for name in NOT_CODE))
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + (" with changes" if changed else "")


def processor():
    with open("/proc/cpuinfo") as lines:
        model = next((line.split(":", 1)[1].strip() for line in lines if re.match(r"model name|Model", line)),
                     "unknown processor")
    return "%s, %d processors" % (model, os.cpu_count())


def stamp(mode, what, of_commit):
    return "# %s run of %s, commit %s, %s, %s" % (mode, what, of_commit, processor(), time.strftime("%Y-%m-%d"))


def main():
    mode, may_fail, table, *rest = sys.argv[1:]
    sides, command = [Path(side) for side in rest[:rest.index("--")]], " ".join(rest[rest.index("--") + 1:])
    part, begin, measured = Path(table + ".part"), time.time(), commit()
    with part.open("w") as output:
        output.write(" " * 1000 + "\n")  # room for the line that is known at the end
        output.flush()
        code = subprocess.call(["bash", "-o", "pipefail", "-c", command], stdout=output, cwd=str(ROOT),
                               stdin=subprocess.DEVNULL)
    if code != 0 and may_fail != "1":
        sys.exit("%s ends with %d; its output is in %s" % (command, code, part))
    first = stamp(mode, "`%s`" % command.replace(str(ROOT) + "/", ""), measured)
    first += (", it ended with %d" % code if code else "") + ", %.3f s\n" % (time.time() - begin)
    for path in sides:
        path.write_text(first + path.read_text())
    Path(table).write_text(first + part.read_text(errors="replace")[1001:])
    part.unlink()


if __name__ == "__main__":
    main()

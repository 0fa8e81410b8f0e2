"""Which code, which machine, which day."""
import hashlib
import os
import re
import subprocess
import time

from .programs import ROOT

# what a document says changes no measurement
NOT_CODE = ("docs", "README.md", "CHANGELOG.rst", "CONTRIBUTING.md", "LICENSE")


def git(*arguments):
    done = subprocess.run(("git", "-C", str(ROOT)) + arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def changes():
    """Code that is not committed."""
    return git("status", "--porcelain", "--", ".", *(":!" + name for name in NOT_CODE))


def code_key():
    """One for each state of the code, whatever the documents say."""
    tree = [line for line in git("ls-tree", "HEAD").splitlines() if line.split("\t")[-1] not in NOT_CODE]
    return hashlib.sha1("\n".join(tree + [changes(), git("diff", "HEAD", "--", ".", *(":!" + n for n in NOT_CODE))]).encode()).hexdigest()


def commit():
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + (" with changes" if changes() else "")


def processor():
    with open("/proc/cpuinfo") as lines:
        model = next((line.split(":", 1)[1].strip() for line in lines if re.match(r"model name|Model", line)), "unknown processor")
    return "%s, %d processors" % (model, os.cpu_count())


def stamp(mode):
    return "%s run of scripts/qualify, commit %s, %s, %s" % (mode, commit(), processor(), time.strftime("%Y-%m-%d"))

"""Where programs are, what a part needs, and the environment in which it runs."""
import os
import re
import shlex
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def build_directory():
    return Path(os.environ.get("AFM_BUILD_DIR", str(ROOT / "build")))


def devel_directory():
    return Path(os.environ.get("AFM_BUILD_DIR", str(ROOT))) / "devel"


def tools_directory():
    return Path(os.environ.get("AFM_TOOLS", str(devel_directory() / "lib/afm_emulator")))


def use_build():
    """The environment of the build: begin again in it."""
    if "AFM_QUALIFY" in os.environ:
        return
    os.environ["AFM_QUALIFY"] = "1"
    setup = devel_directory() / "setup.bash"
    sourced = 'source "$0/scripts/environment.bash"; [[ -f $1 ]] && source_setup "$1"; shift; exec /usr/bin/python3 "$@"'
    os.execvp("bash", ["bash", "-c", sourced, str(ROOT), str(setup)] + sys.argv)


def program_of(command):
    """The first word that is no setting of a variable."""
    return next(word for word in shlex.split(command) if "=" not in word)


def locate(program):
    """A script or a program of the source tree or the build, by its path; a tool by its name; None where there is none."""
    if "/" not in program:
        path = tools_directory() / program
    elif program.startswith("build/"):
        path = build_directory() / program[len("build/"):]
    else:
        path = ROOT / program
    return path if path.exists() else None


def missing_programs(parts):
    """Programs that a part names and that are neither in the tree nor in the build. What a part marks as optional may be missing."""
    return ["%s names %s, which is not there" % (part.name, program)
            for part in parts for program in sorted({program_of(c) for c in part.quick + part.full})
            if not locate(program) and program not in part.optional]


def figures_left_out(parts):
    """Figures that scripts/figures knows and no part makes, or the other way round."""
    known = set(re.findall(r'^    "(\w+)": \w+\.', (ROOT / "scripts/figures").read_text(), re.M))
    made = {name for part in parts for command in part.full if command.startswith("scripts/figures")
            for name in command.split("--only ")[1].split()}
    return ["the figure %s is in no part, or unknown to scripts/figures" % name for name in sorted(known ^ made)]


def has(command):
    return shutil.which(command) is not None


def cannot_run(part):
    for command, package in part.needs.items():
        if not has(command):
            return "needs %s (Debian: %s)" % (command, package)
    for program in {program_of(c) for c in part.full}:
        if not locate(program):
            return "%s is not built" % program if "/" not in program else "no %s" % program
    return None


def lacks(part):
    """What a part that ran could not include: methods that the build was made without."""
    if part.name not in ("chart", "matrix"):
        return []
    cache = (build_directory() / "CMakeCache.txt").read_text()
    found = {"CVODE": "SUNDIALS_INCLUDE_DIR", "Siconos": "SICONOS_INCLUDE_DIR", "heyoka": "heyoka_DIR"}
    return ["without %s, which was not found when the build was configured" % name for name, variable in found.items()
            if not re.search(r"^%s:\w+=/" % variable, cache, re.M)]

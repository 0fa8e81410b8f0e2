# Everything that a document quotes: measured, made into tables, drawn. Needs the build of scripts/build --tests.
#
#   snakemake --list                              the rules; the name of a table or of a picture is one
#   snakemake fig1_friction -c2 --config quick=1  a short run, in minutes
#   snakemake load thermal_hops -c2               full runs; all of them take a night
#   snakemake publish -c1                         copies full runs to docs/, and renders the tables in the documents
#
# Results lie in build/laboratory/quick and build/laboratory/full. What is there is not measured again, unless its
# command changed or its program was built anew; an interrupted run goes on where it was.
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, workflow.basedir + "/workflow")
from commands import commands
from make import PICTURES, TABLES
from registry import names_read

ROOT = Path(workflow.basedir)
QUICK = bool(config.get("quick"))
MODE = "quick" if QUICK else "full"
BUILD = Path(os.environ.get("AFM_BUILD_DIR", ROOT / "build"))
DEVEL = Path(os.environ.get("AFM_BUILD_DIR", ROOT)) / "devel"
TOOLS = Path(os.environ.get("AFM_TOOLS", DEVEL / "lib/afm_emulator"))
OUT = str(BUILD / "laboratory" / MODE)
COMMANDS = commands(QUICK)
MADE = {name: table for name, table in TABLES.items() if not (QUICK and table.full_only)}
BUILT = [str(path) for path in (TOOLS / "real_time", TOOLS / "emulator_node",
                                *DEVEL.glob("lib/python3*/*/afm/_afm*.so")) if path.exists()]
EXAMPLES = ("friction_peaks", "bifurcations", "thermal_histogram", "friction_of_lever")  # in Python, with a picture
SHELL = ('source scripts/environment.bash; ! [[ -f "%s/setup.bash" ]] || source_setup "%s/setup.bash"; '
         'export PATH="%s:$PATH"; ')

workdir: str(ROOT)
shell.executable("/bin/bash")
shell.prefix(SHELL % (DEVEL, DEVEL, TOOLS))


def any_of(names):
    return "|".join(re.escape(name) for name in names)


def table(name):
    """Where a table is: made from others, or as a program wrote it."""
    return "%s/%s/%s.csv" % (OUT, "data" if name in MADE else "tables", name)


def image(name):
    return "%s/images/%s.png" % (OUT, name)


def program(words):
    """The file of the program that a command runs, where it was built. A script runs the tip by others."""
    name = next(word for word in words.split() if "=" not in word)
    path = ROOT / name if "/" in name else TOOLS / name
    return [str(path)] * path.exists() + (BUILT if "/" in name else [])


def words(name):
    return COMMANDS[name].words.replace("{out}", OUT + "/tables")


# what a name stands for, and groups of such names
TARGETS = {name: [table(name)] for command in COMMANDS.values() for name in command.sides}
for name in list(COMMANDS) + list(MADE):
    TARGETS.setdefault(name, []).append(table(name))
for name in PICTURES:
    TARGETS.setdefault(name, []).append(image(name))
TARGETS.update({name: [image(name)] for name in EXAMPLES})
TARGETS.update({"view": [image("view")],
                "scene_pictures": [image(name) for name in PICTURES if name.startswith("scene_")],
                "chart": TARGETS["speed_accuracy"] + TARGETS["pace"]})
TARGETS["scenes"] = TARGETS["scene_pictures"] + TARGETS["scene_levels"]
TARGETS["paper"] = [file for name in PICTURES if re.match("fig|model", name) for file in TARGETS[name]] + \
    [table(name) for name in ("mica_in_si", "friction_attractors", "friction_orbits", "friction_averages")]
TARGETS["hammer"] = [file for name in PICTURES if name.startswith("hammer") for file in TARGETS[name]]
HEATED = [name for name in list(MADE) + list(PICTURES) if re.match("thermal|load", name)]
TARGETS["lever_pictures"] = TARGETS["lever_map"] + TARGETS["lever_friction"]
TARGETS["temperature"] = [file for name in HEATED for file in TARGETS[name]] + [table("thermal_real_time")]
LISTED = [name for name in TARGETS if name not in COMMANDS or name in TABLES or
          (ROOT / "docs/data" / (name + ".csv")).exists()]


rule all:
    input: sorted({file for files in TARGETS.values() for file in files})

for name in LISTED:
    rule:
        name: name
        input: sorted(set(TARGETS[name]))

rule measure:
    output: OUT + "/tables/{name}.csv"
    input: lambda wildcards: program(COMMANDS[wildcards.name].words)
    wildcard_constraints: name=any_of(name for name, command in COMMANDS.items() if not command.sides)
    params:
        words=lambda wildcards: words(wildcards.name),
        may_fail=lambda wildcards: int(COMMANDS[wildcards.name].may_fail)
    threads: workflow.cores  # the programs use all, or are timed
    shell: "workflow/measure.py {MODE} {params.may_fail} {output} -- {params.words:q}"

for name, command in COMMANDS.items():
    if command.sides:
        rule:
            name: "measure_" + name
            output: table(name), *(table(side) for side in command.sides)
            input: program(command.words)
            params: words=words(name), may_fail=int(command.may_fail)
            threads: workflow.cores
            shell: "workflow/measure.py {MODE} {params.may_fail} {output} -- {params.words:q}"

rule table:
    output: OUT + "/data/{name}.csv"
    input: lambda wildcards: [table(name) for name in names_read(TABLES[wildcards.name], QUICK)]
    wildcard_constraints: name=any_of(MADE)
    shell: "workflow/make.py {MODE} table {wildcards.name} {OUT}/tables {OUT}/data {output}"

rule picture:
    output: OUT + "/images/{name}.png"
    input: lambda wildcards: [table(name) for name in names_read(PICTURES[wildcards.name], QUICK)] + BUILT
    wildcard_constraints: name=any_of(PICTURES)
    shell: "workflow/make.py {MODE} picture {wildcards.name} {OUT}/tables {OUT}/data {output}"

rule example_picture:
    output: OUT + "/images/{name}.png"
    input: "examples/python/{name}.py", *BUILT
    wildcard_constraints: name=any_of(EXAMPLES)
    shell: "cd {OUT}/images && {ROOT}/{input[0]}"

rule view_picture:
    output: image("view")
    input: *BUILT
    threads: workflow.cores
    shell: "workflow/view_picture {output}"

rule publish:
    shell: "workflow/documents.py --publish {BUILD}/laboratory/full"

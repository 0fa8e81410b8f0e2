"""What becomes of the outputs of each part. Each function takes a Publisher and [(command, output, exit code)]."""
import re

from .programs import ROOT
from .results import benchmark_rows, best_of, last_line, read_table, rows_of


def nothing(publisher, outputs):
    pass


def files(*names):
    def keep(publisher, outputs):
        for name in names:
            publisher.file(name)
    return keep


def printed(name):
    return lambda publisher, outputs: publisher.table(name, rows_of(outputs[0][1]))


def verbs(publisher, outputs):
    publisher.table("verbs.csv", benchmark_rows(outputs[0][1]))


def real_time(publisher, outputs):
    publisher.table("real_time.csv", best_of([rows_of(text) for _, text, _ in outputs]))


def grazes(publisher, outputs):
    rows = [row for i, (_, text, _) in enumerate(outputs) for row in rows_of(text)
            if i == 0 or not row["graze"].startswith("ordinary")]
    publisher.table("grazes.csv", rows)


STRESS = re.compile(r"(\d+) scenes of (\d+) tau: (\d+) commands, (\d+) \w+, (\d+) impacts standing for (\d+) bounces.*"
                    r"in a tau (\d+), deepest (\S+) a, worst imbalance (\S+)")


def stress(publisher, outputs):
    rows = []
    for (command, text, code), models in zip(outputs, ("any model, drag 1e-6 to 100", "mica, drag up to 9", "the shipped node's budget")):
        found = STRESS.findall(text)
        if not found:
            raise SystemExit("qualify: no result of %s" % command)
        scenes, tau, commands, segments, _, bounces, most, deepest, imbalance = found[-1]
        rows.append({"models": models, "tau": "%.2g" % (int(scenes) * int(tau)), "commands": "%.2g" % int(commands),
                     "segments": "%.2g" % int(segments), "bounces": "%.2g" % int(bounces), "violations": "0" if code == 0 else "at least 1",
                     "deepest / a": deepest, "worst imbalance": imbalance, "most segments in a tau": most})
    publisher.table("stress.csv", rows)


LEVEL = ("eta", "gamma", "cutoff", "frequency_ratio", "amplitude", "rest_height", "model", "contact_tolerance")


def levels(publisher, outputs):
    path = publisher.scratch / "levels.csv"
    path.write_text("# %s\n%s" % (publisher.stamp, path.read_text()))  # to be copied as it is
    new, shipped = read_table(path), read_table(ROOT / "config/levels.csv")
    errors = {tuple(row[name] for name in LEVEL): row["k_f_error"] for row in shipped}
    same = sum(errors.get(tuple(row[name] for name in LEVEL)) == row["k_f_error"] for row in new)
    print("    %d of %d levels have the error of config/levels.csv; the new table is %s" % (same, len(new), path))


def recording(publisher, outputs):
    lines = [line for line in outputs[0][1].splitlines() if "MB resident" in line]
    found = re.search(r"([\d.]+) s, +(\d+) MB resident, per cent of a core: (.*)", lines[-1])
    bags = re.search(r"([\d.]+) GB in (\d+) bags", outputs[0][1])
    publisher.table("recording_cost.csv", [dict([("seconds", found[1]), ("memory / MB", found[2]), ("recorded / GB", bags[1])] +
                                                [part.rsplit(" ", 1) for part in found[3].split(", ")])])
    for bag in (publisher.scratch / "bags").glob("*.bag"):
        bag.unlink()


def soak(publisher, outputs):
    for (command, text, code), what in zip(outputs, ("soak", "soak, faster")):
        lines = [line.strip() for line in text.splitlines() if re.search(r"wall time|memory|recordings identical|FAULT", line)]
        publisher.note(what, command, ("" if code == 0 else "FAILED: ") + "; ".join(lines))


def sanitized(publisher, outputs):
    command, text, code = outputs[0]
    tests = re.search(r"\d+% tests passed, \d+ tests failed out of \d+", text)
    what = "memory, undefined behaviour" if "address" in command else "races"
    publisher.note(what, command, "%s; %s" % (tests[0] if tests else "no tests ran", "no report" if code == 0 else "FAILED: " + last_line(text)))


def leaks(publisher, outputs):
    command, text, code = outputs[-1]
    publisher.note("leaks", command.split(" ", 1)[1], "0 errors, 0 bytes lost" if code == 0 else "FAILED: " + last_line(text))


def fuzz(publisher, outputs):
    command, text, code = outputs[0]
    runs = re.search(r"number_of_executed_units: (\d+)", text)
    finding = re.search(r"SUMMARY: .*|ALARM.*|Test unit written to .*", text)
    found = "no finding" if code == 0 and runs and not finding else "FAILED: %s" % (finding[0] if finding else last_line(text))
    publisher.note("fuzzing: " + command.split()[-2], command.replace(" 2>&1", ""),
                   "%s inputs: %s" % ("{:,}".format(int(runs[1])) if runs else "?", found))


def builds(publisher, outputs):
    command, text, code = outputs[0]
    publisher.note("compilers", command, last_line(text) if code == 0 else "FAILED: " + last_line(text))


def figures(publisher, outputs):
    for path in sorted(publisher.scratch.glob("*.csv")):
        publisher.file(path.name)

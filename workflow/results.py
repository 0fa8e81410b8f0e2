"""Tables made from what programs print."""
import itertools
import re

from commands import (FUZZED, LEVER_KICKS, LIQUID_KICKS, LIQUID_MORE, LOCK_KICKS, LOCK_QUALITIES, LOCK_RATIOS,
                      MORE_KICKS)
from registry import table


@table(lambda quick: ["verbs_%d" % i for i in range(1 if quick else 3)])
def verbs(tables):
    """The least of several runs."""
    runs = [tables.strings("verbs_%d" % i) for i in range(1 if tables.quick else 3)]
    return [{name: best[name] for name in ("name", "iterations", "real_time", "cpu_time", "time_unit")}
            for best in (min(same, key=lambda row: float(row["cpu_time"])) for same in zip(*runs))]


@table(lambda quick: ["real_time_%d" % i for i in range(1 if quick else 3)])
def real_time(tables):
    """At each point the fastest of several runs, and the least of the slowest tau."""
    runs = [tables.strings("real_time_%d" % i) for i in range(1 if tables.quick else 3)]
    for run in runs[1:]:
        for best, row in zip(runs[0], run):
            best["times_real_time"] = max(best["times_real_time"], row["times_real_time"], key=float)
            best["slowest_tau_us"] = min(best["slowest_tau_us"], row["slowest_tau_us"], key=float)
    return runs[0]


@table("grazes_flight", "grazes_start", "grazes_tau")
def grazes(tables):
    return tables.strings("grazes_flight") + [row for name in ("grazes_start",
                                                               "grazes_tau") for row in tables.strings(name)
                                              if not row["graze"].startswith("ordinary")]


def with_error(row):
    return "%.4f +- %.4f" % (row["k_f_work"], row["k_f_work_std_error"])


def by_rate(rows, own, more):
    """K_f by work at a rate of its own, and at more of them."""
    names = ["K_f", *("K_f at %g kicks" % kicks for kicks in more)]
    return {"kicks per tau": "%g" % own, **dict(zip(names, map(with_error, rows)))}


@table(*["lever_kicks_%g_%g" % (ratio, kicks) for ratio, own in LEVER_KICKS.items() for kicks in (own, *MORE_KICKS)])
def lever_kicks(tables):
    """K_f by work at each rate of kicks."""
    result = []
    for ratio, own in LEVER_KICKS.items():
        for rows in zip(*(tables.rows("lever_kicks_%g_%g" % (ratio, kicks)) for kicks in (own, *MORE_KICKS))):
            result.append({"omega_h/omega_v": "%g" % ratio, "rest height": "%g" % rows[0]["rest_height"],
                           "eta": "%g" % rows[0]["eta"], **by_rate(rows, own, MORE_KICKS)})
    return result


@table(*["liquid_kicks_%g_%g_%g" % (*case, kicks) for case, own in LIQUID_KICKS.items()
         for kicks in (own, *LIQUID_MORE)])
def liquid_kicks(tables):
    """K_f by work where the tip is damped as in a liquid."""
    result = []
    for case, own in LIQUID_KICKS.items():
        for rows in zip(*(tables.rows("liquid_kicks_%g_%g_%g" % (*case, kicks)) for kicks in (own, *LIQUID_MORE))):
            result.append({"omega_h/omega_v": "%g" % case[0], "Q": "%g" % case[1], "eta": "%g" % rows[0]["eta"],
                           **by_rate(rows, own, LIQUID_MORE)})
    return result


@table(*["locked_kicks_%g_%g_%g" % case for case in itertools.product(LOCK_RATIOS, LOCK_QUALITIES, LOCK_KICKS)])
def locked_kicks(tables):
    """K_f by work at rates of kicks of which some lock to the lateral spring."""
    result = []
    for ratio, quality in itertools.product(LOCK_RATIOS, LOCK_QUALITIES):
        row = {"omega_h/omega_v": "%g" % ratio, "Q": "%g" % quality}
        for kicks in LOCK_KICKS:
            at, = tables.rows("locked_kicks_%g_%g_%g" % (ratio, quality, kicks))
            row["K_f at %g kicks" % kicks] = with_error(at)
        result.append(row)
    return result


STRESS = re.compile(r"(\d+) scenes of (\d+) tau: (\d+) commands, (\d+) \w+, (\d+) impacts standing for (\d+) bounces.*"
                    r"in a tau (\d+), deepest (\S+) a, worst imbalance (\S+)")


@table("stress_any", "stress_mica", "stress_shipped", "stress_levers")
def stress(tables):
    rows = []
    for name, models in (("any", "any model and bath, drag 1e-6 to 100"), ("mica", "mica, drag up to 9"),
                         ("shipped", "the shipped node's budget"),
                         ("levers", "levers, crystals, loads to 100 nN, baths")):
        found = STRESS.findall(tables.text("stress_" + name))
        scenes, tau, commands, segments, _, bounces, most, deepest, imbalance = found[-1]
        rows.append({"models": models, "tau": "%.2g" % (int(scenes) * int(tau)), "commands": "%.2g" % int(commands),
                     "segments": "%.2g" % int(segments), "bounces": "%.2g" % int(bounces),
                     "violations": "at least 1" if failed(tables, "stress_" + name) else "0", "deepest / a": deepest,
                     "worst imbalance": imbalance, "most segments in a tau": most})
    return rows


def failed(tables, name):
    return ", it ended with " in tables.stamp(name)


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else "no output"


def soak_result(text):
    return "; ".join(line.strip() for line in text.splitlines()
                     if re.search(r"wall time|memory|recordings identical|FAULT", line))


def sanitizer_result(text):
    tests = re.search(r"\d+% tests passed, \d+ tests failed out of \d+", text)
    return tests[0] if tests else "no tests ran"


def fuzz_result(text):
    runs = re.search(r"number_of_executed_units: (\d+)", text)
    finding = re.search(r"SUMMARY: .*|ALARM.*|Test unit written to .*", text)
    if not (runs or finding):
        return "nothing was fuzzed"
    return "%s inputs: %s" % ("{:,}".format(int(runs[1])) if runs else "?",
                              "FAILED: " + finding[0] if finding else "no finding")


RELIABILITY = {"builds": ("compilers", last_line), "leaks": ("leaks", last_line), "soak": ("soak", soak_result),
               "sanitized_address": ("memory, undefined behaviour", sanitizer_result),
               "sanitized_thread": ("races", sanitizer_result),
               **{"fuzz_" + name: ("fuzzing: " + name, fuzz_result) for name in FUZZED}}


@table(*RELIABILITY, full_only=True)
def reliability(tables):
    rows = []
    for name, (what, result) in RELIABILITY.items():
        stamp = re.search(r"run of (`.*`), commit ([^,]*),.*(\d{4}-\d\d-\d\d)", tables.stamp(name))
        rows.append({"what": what, "command": stamp[1], "result": ("FAILED: " if failed(tables, name) else "")
                     + result(tables.text(name)),
                     "commit": stamp[2], "date": stamp[3]})
    return sorted(rows, key=lambda row: row["what"])

"""Short tables for the documents, a row a method or a line of text, from the full ones beside them in docs/data."""
import math
import statistics

from registry import short_table

CHANCE = 0.01     # scenes with a wider threshold are chaotic
ROUNDING = 1e-12  # errors below are


def short_time(nanoseconds):
    for unit, size in (("ns", 1.0), ("us", 1e3), ("ms", 1e6)):
        if nanoseconds < 999.5 * size or unit == "ms":
            return "%.3g %s" % (nanoseconds / size, unit)


def short(value):
    number = float(value)
    if number == 0 or not math.isfinite(number):
        return "%g" % number
    if 0.01 <= abs(number) < 1000:
        return "%.3g" % number
    digits, exponent = ("%.1e" % number).split("e")
    return "%se%d" % (digits, int(exponent))


def bold(method):
    return "**%s**" % method if method == "exact" else method


def usual_settings(tables):
    """Of each method, what the matrix runs it with."""
    return {row["method"]: row["setting"] for row in tables.strings("stability") if row["scene"] == "even"}


def ratio(row):
    value = float(row["ratio_to_exact"])
    return "1" if row["method"] == "exact" else "%.2g" % value if value < 10 else "%.0f" % value


@short_table("speed_accuracy", "stability")
def accuracy_methods(tables):
    usual = dict(usual_settings(tables), exact="0")  # one flight of this emulator has no setting
    return [{"method": bold(r["method"]), "setting": "" if float(r["setting"]) == 0 else r["setting"],
             "time per impact": short_time(float(r["ns_per_impact"])), "time ratio": ratio(r),
             "error, median": short(r["error_median"]), "error, 99 %": short(r["error_p99"]), "missed": r["missed"],
             "phantom": r["phantom"], "of": r["impacts"]}
            for r in tables.strings("speed_accuracy") if r["scene"] == "all" and usual.get(r["method"]) == r["setting"]]


@short_table("pace", "stability")
def pace_methods(tables):
    usual, table, order = usual_settings(tables), {}, ("2", "3.4", "3")
    for r in sorted(tables.strings("pace"), key=lambda r: order.index(r["scene"][3:])):
        method, eta = r["method"], r["scene"][3:]
        if usual.get(method) == r["setting"]:
            row = table.setdefault(method, {"method": bold(method),
                                            "setting": "" if float(usual[method]) == 0 else usual[method]})
            row["eta = %s: error of K_f" % eta] = short(r["k_f_error"])
            row["CPU s per model s (%s)" % eta] = short(r["seconds_per_second"])
    return list(table.values())


@short_table("stability")
def rival_wins(tables):
    """Cells in which a rival is right too, and faster, or clearly nearer beyond chance and rounding."""
    rows = tables.strings("stability")
    ours = {row["scene"]: row for row in rows if row["method"] == "exact"}
    table = []
    for r in (row for row in rows if row["verdict"] == "right" and not row["method"].startswith("exact")):
        own, chaotic = ours[r["scene"]], float(r.get("right_below") or 0) > CHANCE
        nearer = not chaotic and float(own["number"]) > ROUNDING and float(r["number"]) < 0.5 * float(own["number"])
        if nearer or float(r["ns_per_tau"]) < float(own["ns_per_tau"]):
            table.append({"scene": r["scene"], "method": r["method"], "error": short(r["number"]),
                          "this emulator: error": short(own["number"]),
                          "time of a tau": short_time(float(r["ns_per_tau"])),
                          "this emulator: time": short_time(float(own["ns_per_tau"]))})
    return table or [{"scene": "none", "method": ""}]


@short_table("real_time")
def real_time_slowest(tables):
    rows = sorted(tables.strings("real_time"), key=lambda row: float(row["times_real_time"]))[:10]
    return [{"eta": "%.4g" % float(r["eta"]), "v_c": "%.4g" % float(r["cutoff"]),
             "times real time": r["times_real_time"], "slowest tau / us": r["slowest_tau_us"]} for r in rows]


@short_table("real_time")
def real_time_points(tables):
    rows = tables.rows("real_time")
    times = sorted(row["times_real_time"] for row in rows)
    return [{"points": len(rows), "above 10 times real time": sum(t > 10 for t in times),
             "above 20 times": sum(t > 20 for t in times), "median": "%.3g" % times[len(times) // 2],
             "slowest": "%.3g" % times[0], "failed searches": "%d" % sum(row["search_failures"] for row in rows)}]


@short_table("levers")
def lever_points(tables):
    """Of all levers, crystals, loads and speeds: how many keep real time."""
    rows, table = tables.rows("levers"), []
    for bath, column in (("none", "times_real_time"), ("300 K, Q = 100", "heated_times_real_time")):
        times = sorted(row[column] for row in rows)
        unloaded = sorted(row[column] for row in rows if row["load_nn"] == 0)
        table.append({"bath": bath, "points": len(times), "below 1 x": sum(t < 1 for t in times),
                      "1 to 3 x": sum(1 <= t < 3 for t in times), "3 to 10 x": sum(3 <= t < 10 for t in times),
                      "above 10 x": sum(t >= 10 for t in times), "median": "%.2g" % statistics.median(times),
                      "median without load": "%.2g" % statistics.median(unloaded)})
    return table


@short_table("verbs")
def bounce_times(tables):
    times = {row["name"]: float(row["cpu_time"]) for row in tables.strings("verbs")}
    etas = [name.split("/")[1] for name in times if name.startswith("Bounce/")]
    return [{"eta": "%g" % (int(eta) / 100.0), "impact / ns": "%.0f" % times["Bounce/" + eta],
             "of it the search / ns": "%.0f" % times["Search/" + eta]} for eta in etas]


@short_table("grazes")
def grazes_kinds(tables):
    kinds = {}
    for row in tables.strings("grazes"):
        kind = "ordinary flights" if row["graze"].startswith("ordinary") else row["graze"]
        sums = kinds.setdefault(kind, [0, 0, 0])
        for i, name in enumerate(("flights", "in_double_double", "wrong")):
            sums[i] += int(row[name] or 0)
    return [{"grazes": kind, "flights": flights, "decided in double-double": finer,
             "wrong": "" if kind == "ordinary flights" else wrong} for kind, (flights, finer, wrong) in kinds.items()]


@short_table("burst_error")
def burst_error_table(tables):
    """Of the drag speeds the worst."""
    groups = {}
    for row in tables.rows("burst_error"):
        groups.setdefault((row["gamma"], row["v_c"]), []).append(row)
    table = []
    for (gamma, v_c), rows in groups.items():
        worst = max(rows, key=lambda row: row["99_percent"])
        table.append({"gamma": "%g" % gamma, "v_c": "%g" % v_c, "sequences": "%d" % sum(row["bursts"] for row in rows),
                      "bounces replaced": "%.2g" % sum(row["bounces"] for row in rows),
                      "median": "%.2g" % max(row["median"] for row in rows), "99 %": "%.2g" % worst["99_percent"],
                      "at eta": "%g" % worst["eta"], "largest": "%.2g" % max(row["max"] for row in rows)})
    return table


@short_table("cutoff_friction")
def cutoff_table(tables):
    table = {}
    for r in tables.rows("cutoff_friction"):
        row = table.setdefault(r["cutoff"], {"v_c": "%.4g" % r["cutoff"]})
        row["eta = %.4g" % r["eta"]] = "%.6g" % r["k_f"]
    return list(table.values())


@short_table("scene_levels")
def levels_in_use(tables):
    return [{"scene": row["scene"], "eta": row["eta"], "contact_tolerance": row["contact_tolerance"],
             "error of K_f": short(row["k_f_error"]), "error of the deflection": short(row["deflection_error"]),
             "cost": short(row["cost"])} for row in tables.strings("scene_levels") if row["in_use"] == "1"]

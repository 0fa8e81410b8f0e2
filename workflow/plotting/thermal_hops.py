"""What becomes of coexisting attractors in a heat bath: how often the tip hops between the two."""
from commands import (HOPS, HOPS_QUALITY, KELVIN, MERGE_ETAS, MERGE_QUALITIES, TEMPERATURES, TRACES, windows_name)
from registry import picture, table

from . import style

RATES = tuple(windows_name(eta, theta, HOPS_QUALITY, window, 20000) for eta, (_, window, temperatures) in HOPS.items()
              for theta in temperatures)
TRACED = tuple(windows_name(6.5, theta, HOPS_QUALITY, 50, 20000) for theta in TRACES)
MERGED = tuple(windows_name(eta, kelvin * KELVIN, quality, 50, 5000) for eta in MERGE_ETAS
               for quality in MERGE_QUALITIES for kelvin in TEMPERATURES)


def windows(tables, eta, theta, quality=HOPS_QUALITY, window=20, duration=20000):
    """K_f of the windows of each start."""
    tips = {}
    for row in tables.rows(windows_name(eta, theta, quality, window, duration)):
        tips.setdefault(row["start"], []).append(row["k_f_work"])
    return tips


def count(tips, levels, window):
    """Times spent [tau] on the lower and the upper attractor, and how often each was left for the other."""
    low, high = levels
    spent, left = [0.0, 0.0], [0, 0]
    for values in tips.values():
        on = None
        for value in values:
            place = (value - low) / (high - low)
            now = 0 if place < 0.2 else 1 if place > 0.8 else on
            if on is not None and now != on:
                left[on] += 1
            on = now
            if on is not None:
                spent[on] += window
    return spent, left


@table(*RATES)
def thermal_hops(tables):
    rows = []
    for eta, (levels, window, temperatures) in HOPS.items():
        for theta in temperatures:
            spent, left = count(windows(tables, eta, theta, window=window), levels, window)
            for which, k_f, time, n in zip(("lower", "upper"), levels, spent, left):
                rows.append((eta, HOPS_QUALITY, theta, theta / KELVIN, which, k_f, time, n))
    return ("eta", "quality_factor", "temperature", "temperature_k", "attractor", "k_f_work", "time_spent",
            "times_left"), rows


@table(*MERGED)
def thermal_merge(tables):
    """Do tips from many starts end alike? The least and the greatest mean, and the standard error of each."""
    rows = []
    for eta in MERGE_ETAS:
        for quality in MERGE_QUALITIES:
            for kelvin in TEMPERATURES:
                tips = windows(tables, eta, kelvin * KELVIN, quality, 50, 5000)
                means = sorted(sum(values) / len(values) for values in tips.values())
                spread = [sum((v - sum(values) / len(values)) ** 2 for v in values) for values in tips.values()]
                n = len(tips[0.0])
                error = (sum(spread) / len(tips) / n) ** 0.5 / n ** 0.5
                rows.append((eta, quality, kelvin, "%.4f" % means[0], "%.4f" % means[-1],
                             "%.4f" % error if kelvin else ""))
    return ("eta", "Q", "T / K", "least K_f", "greatest K_f", "standard error of each"), rows


def draw_rates(axes, rows):
    looks = {(2, "upper"): (style.BLUE, "s", {}), (2, "lower"): (style.BLUE, "o", style.OPEN),
             (6.5, "upper"): (style.ORANGE, "s", {}), (6.5, "lower"): (style.ORANGE, "o", style.OPEN)}
    for (eta, which), (colour, mark, fill) in looks.items():
        some = [row for row in rows if row["eta"] == eta and row["attractor"] == which and row["times_left"] > 0]
        if not some:
            continue
        rates = [row["times_left"] / row["time_spent"] for row in some]
        errors = [1.96 * row["times_left"] ** 0.5 / row["time_spent"] for row in some]
        low = [min(error, 0.9 * rate) for rate, error in zip(rates, errors)]  # a logarithm of a positive number
        axes.errorbar([row["temperature_k"] for row in some], rates, [low, errors], marker=mark, color=colour,
                      linewidth=0.9, label=r"$\eta$ = %g, from $K_f$ = %.3g" % (eta, some[0]["k_f_work"]), **fill)
    axes.set(xscale="log", yscale="log", xlim=(0.1, 60), ylim=(5e-7, 2e-2), xlabel="temperature [K]",
             ylabel=r"rate of leaving an attractor for the other [1/$\tau$]")
    style.legend_above(axes, columns=1)


@table(*TRACED)
def thermal_traces(tables):
    """K_f of one tip, window by window."""
    return (("temperature_k", "time", "k_f_work"),
            [(theta / KELVIN, 50 * i, value) for theta in TRACES
             for i, value in enumerate(windows(tables, 6.5, theta, window=50)[0.0][:400])])


def draw_traces(axes, rows):
    for ax, theta in zip(axes, TRACES):
        some = [row for row in rows if abs(row["temperature_k"] / (theta / KELVIN) - 1.0) < 1e-3]
        ax.plot([row["time"] for row in some], [row["k_f_work"] for row in some], color=style.BLUE, linewidth=0.8)
        ax.set_title("%.3g K" % (theta / KELVIN), loc="left")
        for level in HOPS[6.5][0]:
            ax.axhline(level, color="black", linewidth=0.9, linestyle=":")
        ax.set(ylim=(0.37, 0.60), xlim=(0, 20000), ylabel=style.K_F_LABEL)
        ax.tick_params(labelbottom=ax is axes[-1])
    axes[-1].set_xlabel(r"time [$\tau$]")


@picture("thermal_hops", "thermal_traces", name="thermal_hops")
def draw_hops(tables):
    figure = style.figure(7.0)
    grid = figure.add_gridspec(4, 2, width_ratios=[4, 5])
    draw_rates(figure.add_subplot(grid[:, 0]), tables.rows("thermal_hops"))
    draw_traces([figure.add_subplot(grid[i, 1]) for i in range(4)], tables.rows("thermal_traces"))
    return figure

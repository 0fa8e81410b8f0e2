"""What becomes of coexisting attractors in a heat bath: how often the tip hops between the two."""
from . import style
from .temperature import KELVIN

QUALITY = 500
# eta: (K_f of the two attractors without heat, window [tau], kT [m a^2/tau^2])
CASES = {2: ((5.489, 5.646), 20, (0.0003, 0.0005, 0.0007, 0.001, 0.0014, 0.002)),
         6.5: ((0.4397, 0.5056), 50, (0.02, 0.025, 0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.12))}
STARTS = 48


def windows(tables, eta, theta, quality=QUALITY, window=20, duration=20000):
    """K_f of the windows of each start."""
    tips = {}
    name = "windows_%g_%g_%g_%g_%g" % (eta, quality, theta, window, duration)
    for row in tables.make(name, "friction_windows", "--eta", eta, "--temperature",
                           theta, "--quality-factor", quality, "--window", window, "--duration",
                           duration / 10 if tables.quick else duration, "--transient", 300, "--starts", STARTS):
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


def rates(tables):
    rows = []
    for eta, (levels, window, temperatures) in CASES.items():
        for theta in temperatures:
            spent, left = count(windows(tables, eta, theta, window=window), levels, window)
            for which, k_f, time, n in zip(("lower", "upper"), levels, spent, left):
                rows.append((eta, QUALITY, theta, theta / KELVIN, which, k_f, time, n))
    tables.write("thermal_hops", ("eta", "quality_factor", "temperature", "temperature_k", "attractor", "k_f_work",
                                  "time_spent", "times_left"), rows)
    return rows


def merge(tables):
    """Do tips from many starts end alike? The least and the greatest mean, and the standard error of each."""
    rows = []
    for eta in (2, 3.75, 6.5):
        for quality in (500, 100):
            for kelvin in (0, 4, 77, 300):
                tips = windows(tables, eta, kelvin * KELVIN, quality, 50, 5000)
                means = sorted(sum(values) / len(values) for values in tips.values())
                spread = [sum((v - sum(values) / len(values)) ** 2 for v in values) for values in tips.values()]
                n = len(tips[0.0])
                error = (sum(spread) / len(tips) / n) ** 0.5 / n ** 0.5
                rows.append((eta, quality, kelvin, "%.4f" % means[0], "%.4f" % means[-1], "%.4f" % error if kelvin else ""))
    tables.write("thermal_merge", ("eta", "Q", "T / K", "least K_f", "greatest K_f", "standard error of each"), rows)


def draw_rates(axes, rows):
    looks = {(2, "upper"): (style.ORANGE, "s"), (2, "lower"): (style.ORANGE, "o"), (6.5, "upper"): (style.BLUE, "s"),
             (6.5, "lower"): (style.BLUE, "o")}
    for (eta, which), (colour, mark) in looks.items():
        some = [row for row in rows if row[0] == eta and row[4] == which and row[7] > 0]
        if not some:
            continue
        axes.errorbar([row[3] for row in some], [row[7] / row[6] for row in some],
                      [1.96 * row[7] ** 0.5 / row[6] for row in some], marker=mark, color=colour, linewidth=0.8,
                      label=r"$\eta$ = %g, from $K_f$ = %.3g" % (eta, some[0][5]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("temperature / K")
    axes.set_ylabel(r"rate of leaving an attractor for the other / $\tau^{-1}$")
    axes.legend(fontsize=9)


def draw_traces(axes, tables):
    for i, theta in enumerate((0.025, 0.08, 0.2377, 0.926)):
        tips = windows(tables, 6.5, theta, window=50)
        values = tips[0.0][:400]
        axes[i].plot([50 * k for k in range(len(values))], values, color=style.BLUE, linewidth=0.8)
        axes[i].set_ylabel("%.3g K" % (theta / KELVIN))
        for level in CASES[6.5][0]:
            axes[i].axhline(level, color="black", linewidth=0.6, linestyle=":")
        axes[i].set_ylim(0.37, 0.60)
    axes[0].set_title(r"$K_f$ / (m/$\tau$) in windows of 50 $\tau$, $\eta$ = 6.5, Q = 500")
    axes[-1].set_xlabel(r"time / $\tau$")


def hops(tables):
    merge(tables)
    figure = style.pyplot.figure(figsize=(13.0, 6.0), constrained_layout=True)
    grid = figure.add_gridspec(4, 2)
    draw_rates(figure.add_subplot(grid[:, 0]), rates(tables))
    draw_traces([figure.add_subplot(grid[i, 1]) for i in range(4)], tables)
    return figure

"""docs/temperature.md: friction with a heat bath, and what its kicks cost."""
import math

import numpy as np

from commands import BATHS, GOLDEN, QUALITIES, REFERENCE_KICKS, THERMAL_FINE, bath_name, kicks_cases, kicks_name
from registry import picture, table

from . import style

LOOKS = {0: ("black", "-"), 4: (style.GREEN, "--"), 77: (style.BLUE, "-"), 300: (style.ORANGE, "-")}  # [K]
CURVES = tuple("thermal_" + bath_name(*bath) for bath in BATHS)
FINE = tuple("thermal_fine_%s_%g" % (bath_name(*bath), eta) for bath in BATHS for eta in THERMAL_FINE)


def all_curves(tables):
    """(temperature [K], quality factor; 0: no bath): rows"""
    return {bath: tables.rows("thermal_" + bath_name(*bath)) for bath in BATHS}


def draw_curve(axes, rows, label, **look):
    eta = [row["eta"] for row in rows]
    axes.plot(eta, [row["k_f_work"] for row in rows], linewidth=1.1, label=label, **look)
    low, high = ([row["k_f_work"] + sign * 1.96 * row["k_f_work_std_error"] for row in rows] for sign in (-1, 1))
    axes.fill_between(eta, low, high, color=look["color"], alpha=0.25, linewidth=0)


@table(*CURVES, *FINE)
def thermal_friction(tables):
    """The whole curve, with points between its own near the peaks."""
    table_rows = []
    for (kelvin, quality), rows in all_curves(tables).items():
        for eta in THERMAL_FINE:
            rows += tables.rows("thermal_fine_%s_%g" % (bath_name(kelvin, quality), eta))
        table_rows += [(kelvin, quality, row["eta"], row["k_f_work"], row["k_f_work_std_error"], row["k_f"])
                       for row in sorted(rows, key=lambda row: row["eta"])]
    return ("temperature_k", "quality_factor", "eta", "k_f_work", "k_f_work_std_error", "k_f"), table_rows


@picture("thermal_friction", name="thermal_friction")
def draw_thermal_friction(tables):
    curves = {}
    for row in tables.rows("thermal_friction"):
        curves.setdefault((row["temperature_k"], row["quality_factor"]), []).append(row)
    figure, axes = style.new(8.4, len(QUALITIES), 1, sharex=True, sharey=True)
    for ax, quality in zip(axes, QUALITIES):
        draw_curve(ax, curves[0, 0], "no bath", color="#aaaaaa")
        for kelvin, (colour, line) in LOOKS.items():
            draw_curve(ax, curves[kelvin, quality], "%g K" % kelvin, color=colour, linestyle=line)
        ax.set_ylabel(style.K_F_LABEL)
        ax.set_title("quality factor Q = %g" % quality, loc="left")
        ax.set_ylim(0, 6.6)
    style.legend_above(axes[0], columns=5)
    axes[-1].set(xlabel=style.ETA_LABEL, xlim=(0, 9))
    return figure


def at(rows, eta):
    return min(rows, key=lambda row: abs(row["eta"] - eta))


AVERAGED = 0.1  # of the difference between peak and trough: how exact the mean has to be


def averaging_time(peak, trough, duration):
    """For which the standard error of the peak's K_f is a tenth of its height over the trough [tau]."""
    height = peak["k_f_work"] - trough["k_f_work"]
    return duration * (peak["k_f_work_std_error"] / (AVERAGED * height)) ** 2


@table(*CURVES)
def thermal_even_odd(tables):
    """K_f at even and odd eta, and the time that averages it."""
    duration, curves = 1000 if tables.quick else 20000, all_curves(tables)
    rows = []
    for (kelvin, quality), curve_rows in curves.items():
        at_even = [at(curve_rows, eta) for eta in (2, 4, 6)]
        troughs = [at(curve_rows, eta) for eta in (3, 5, 7)]
        needed = max(averaging_time(at_even[2], trough, duration) for trough in troughs[1:])
        memory = quality / (2.0 * math.pi)  # in which a free spring forgets its energy [tau]: no mean is shorter
        rows.append([kelvin, quality or "no bath"] + ["%.3f" % row["k_f_work"] for row in at_even + troughs]
                    + [("%.2g" % needed if needed > memory else "below %.2g" % memory) if kelvin else ""])
    return ("T / K", "Q", *("eta = %d" % eta for eta in (2, 4, 6, 3, 5, 7)), "averaging time / tau"), rows


def maximum(rows):
    """Place and height of the peak: the vertex of a parabola through the five points about the greatest K_f.

    Each with its standard error, from the scatter of the points about the parabola or from their own errors, whichever
    is greater.
    """
    top = max(range(2, len(rows) - 2), key=lambda i: rows[i]["k_f_work"])
    near = rows[top - 2:top + 3]
    x = np.array([row["eta"] for row in near]) - rows[top]["eta"]
    y = np.array([row["k_f_work"] for row in near])
    c, covariance = np.polyfit(x, y, 2, cov="unscaled")
    scatter = np.sum((y - np.polyval(c, x)) ** 2) / (len(x) - 3)
    covariance *= max(scatter, np.mean([row["k_f_work_std_error"] ** 2 for row in near]))
    place = -c[1] / (2.0 * c[0])
    by_c = np.array([-place / c[0], -1.0 / (2.0 * c[0]), 0.0])  # derivatives of the place
    by_height = np.array([place ** 2, place, 1.0])
    return (rows[top]["eta"] + place, (by_c @ covariance @ by_c) ** 0.5,
            np.polyval(c, place), (by_height @ covariance @ by_height) ** 0.5)


def width(rows, height):
    """For how much of eta K_f is above half the peak's height, and its standard error."""
    total, variance = 0.0, 0.0
    for left, right in zip(rows, rows[1:]):
        step = right["eta"] - left["eta"]
        above = [row["k_f_work"] - 0.5 * height for row in (left, right)]
        rise = above[1] - above[0]
        if above[0] * above[1] < 0.0:  # K_f is linear between two points
            total += step * max(above) / abs(rise)
            noise = max(left["k_f_work_std_error"], right["k_f_work_std_error"])
            variance += (step * noise / rise) ** 2
        elif above[0] > 0.0:
            total += step
    return total, variance ** 0.5


@table(*("thermal_peak_%s_%d" % (bath_name(*bath), eta) for bath in BATHS for eta in (2, 4, 6)))
def thermal_peaks(tables):
    """Place, height and width of the first three peaks, on a fine grid about each."""
    rows = []
    for kelvin, quality in BATHS:
        for eta in (2, 4, 6):
            fine = tables.rows("thermal_peak_%s_%d" % (bath_name(kelvin, quality), eta))
            place, place_error, height, height_error = maximum(fine)
            half, half_error = width(fine, height)
            three = ((place, place_error), (height, height_error), (half, half_error))
            rows.append([kelvin, quality or "no bath", "%d" % (eta / 2)] + [
                "%.3f ± %.3f" % (value, math.ceil(1960 * error) / 1000) for value, error in three])
    return ("T / K", "Q", "peak", "at eta", "K_f / (m_tip/tau)", "width"), rows


def kicks_read(quick):
    return [kicks_name(*case, kicks) for case in kicks_cases(quick)
            for kicks in (GOLDEN[::3] if quick else GOLDEN) + (REFERENCE_KICKS,)]


@table(kicks_read)
def thermal_kicks(tables):
    """Error of K_f against the rate of kicks."""
    duration, rows = 1000 if tables.quick else 100000, []
    for case in kicks_cases(tables.quick):
        truth, = tables.rows(kicks_name(*case, REFERENCE_KICKS))
        for kicks in GOLDEN[::3] if tables.quick else GOLDEN:
            name = kicks_name(*case, kicks)
            row, = tables.rows(name)
            error = row["k_f_work"] - truth["k_f_work"]
            noise = (row["k_f_work_std_error"] ** 2 + truth["k_f_work_std_error"] ** 2) ** 0.5
            rows.append((*case, kicks, truth["k_f_work"], error / truth["k_f_work"], noise / truth["k_f_work"],
                         tables.seconds(name) / duration * 1e6))
    columns = ("eta", "quality_factor", "temperature", "kicks_per_tau", "k_f_work", "error", "std_error", "us_per_tau")
    return columns, rows


def draw_kicks(axes, rows):
    """Of all speeds and quality factors the median and the worst error, at each rate of kicks."""
    rates = sorted({row["kicks_per_tau"] for row in rows})
    for kelvin, colour, marker, fill in ((0, style.BLUE, "o", {}), (300, style.ORANGE, "s", style.OPEN)):
        errors = [sorted(abs(row["error"]) for row in rows if row["kicks_per_tau"] == rate
                         and (row["temperature"] > 0) == (kelvin > 0)) for rate in rates]
        axes.plot(rates, [max(e) for e in errors], marker + "--", color=colour, label="worst, %d K" % kelvin, **fill)
        axes.plot(rates, [e[len(e) // 2] for e in errors], marker + "-", color=colour, label="median, %d K" % kelvin,
                  **fill)
    axes.axvline(GOLDEN[5], color="black", linestyle=":", linewidth=1.2)
    axes.text(GOLDEN[5] * 1.05, 0.5, "default", va="top")
    axes.set(xscale="log", yscale="log")
    axes.set_xticks([3, 10, 30, 100])
    axes.set_xticklabels(["3", "10", "30", "100"])
    axes.minorticks_off()
    axes.set(ylim=(1e-4, 0.9), xlabel=r"kicks of the bath per $\tau$",
             ylabel=r"relative error of $K_f$ against %.0f kicks per $\tau$" % REFERENCE_KICKS)
    style.legend_above(axes, columns=2)


def draw_thermostats(axes, rows):
    looks = {("exact", float("inf")): ("exact motion between kicks", style.ORANGE, "*", "-", {}),
             ("baoab_penalty", 1.0): (r"BAOAB, penalty spring, $\omega_p h$ = 1", style.BLUE, "o", "-", {}),
             ("baoab_penalty", 0.25): (r"BAOAB, $\omega_p h$ = 1/4", style.BLUE, "o", ":", style.OPEN),
             ("euler_maruyama_penalty", 1.0): (r"Euler-Maruyama, $\omega_p h$ = 1", style.GREEN, "s", "-", {}),
             ("euler_maruyama_penalty", 0.25): (r"Euler-Maruyama, $\omega_p h$ = 1/4", style.GREEN, "s", ":", style.OPEN)}
    for (method, stiffness), (label, colour, mark, line, fill) in looks.items():
        some = [row for row in rows if (row["method"], row["stiffness"]) == (method, stiffness)]
        axes.errorbar([row["us_per_tau"] for row in some], [abs(row["bias"]) for row in some],
                      [1.96 * row["std_error"] for row in some], color=colour, marker=mark, label=label, linewidth=0.9,
                      linestyle=line, markersize=10 if mark == "*" else 5, **fill)
    axes.axvline(157.0, color="black", linestyle=":", linewidth=1.2)
    axes.text(150.0, 1.2e-4, "real time", rotation=90, ha="right", va="bottom")
    axes.set(xscale="log", yscale="log", ylim=(1e-4, 0.2), xlabel=r"processor time per $\tau$ [$\mu$s]",
             ylabel=r"relative bias of $\langle (y - y_0)^2 \rangle$ at equilibrium")
    style.legend_above(axes, columns=2)


@picture("thermal_kicks", "thermostats")
def thermal_accuracy(tables):
    figure, (left, right) = style.new(5.2, 1, 2, gridspec_kw={"width_ratios": [4, 5]})
    draw_kicks(left, tables.rows("thermal_kicks"))
    draw_thermostats(right, tables.rows("thermostats"))
    return figure

"""docs/temperature.md: friction with a heat bath, and what its kicks cost."""
import math

import numpy as np

from . import style

KELVIN = 0.926 / 300.0  # kT of mica's tip [m a^2/tau^2] for each kelvin; docs/temperature.md
TEMPERATURES = {0: "#000000", 4: style.BLUE, 77: style.GREEN, 300: style.ORANGE}  # [K]
QUALITIES = (500, 100, 20)
GOLDEN = [2.618, 4.236, 6.854, 11.09, 17.944, 29.034, 46.979, 76.013]  # powers of the golden ratio [1/tau]
REFERENCE = 122.99


def curve(tables, kelvin, quality):
    bath = [] if quality == 0 else ["--quality-factor", quality, "--temperature", kelvin * KELVIN]
    return tables.make("thermal_%g_%g" % (kelvin, quality), "friction_curve", "--eta",
                       "0.5:9:0.5" if tables.quick else "0.05:9:0.05", "--duration", 1000 if tables.quick else 20000,
                       *bath)


def all_curves(tables):
    """(temperature [K], quality factor; 0: no bath): rows"""
    curves = {(0, 0): curve(tables, 0, 0)}
    for quality in QUALITIES:
        curves.update({(kelvin, quality): curve(tables, kelvin, quality) for kelvin in TEMPERATURES})
    return curves


def draw_curve(axes, rows, colour, label):
    eta = [row["eta"] for row in rows]
    axes.plot(eta, [row["k_f_work"] for row in rows], color=colour, linewidth=1.1, label=label)
    low, high = ([row["k_f_work"] + sign * 1.96 * row["k_f_work_std_error"] for row in rows] for sign in (-1, 1))
    axes.fill_between(eta, low, high, color=colour, alpha=0.3, linewidth=0)


def friction(tables):
    curves = all_curves(tables)
    tables.write("thermal_friction", ("temperature_k", "quality_factor", "eta", "k_f_work", "k_f_work_std_error", "k_f"),
                   [(kelvin, quality, row["eta"], row["k_f_work"], row["k_f_work_std_error"], row["k_f"])
                    for (kelvin, quality), rows in curves.items() for row in rows])
    publish_peaks(tables, curves)
    publish_maxima(tables)
    figure, axes = style.new(9.0, 10.0, len(QUALITIES), 1, sharex=True, sharey=True)
    for ax, quality in zip(axes, QUALITIES):
        draw_curve(ax, curves[0, 0], "#bbbbbb", "no bath")
        for kelvin, colour in TEMPERATURES.items():
            draw_curve(ax, curves[kelvin, quality], colour, "%g K" % kelvin)
        ax.set_ylabel("Q = %g:  " % quality + style.K_F_LABEL)
        ax.grid(color="#dddddd", linewidth=0.6)
        ax.set_ylim(0, 6.6)
    axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=5, frameon=False)
    axes[-1].set_xlabel(style.ETA_LABEL)
    axes[-1].set_xlim(0, 9)
    return figure


def at(rows, eta):
    return min(rows, key=lambda row: abs(row["eta"] - eta))


AVERAGED = 0.1  # of the difference between peak and trough: how exact the mean has to be


def averaging_time(peak, trough, duration):
    """For which the standard error of the peak's K_f is a tenth of its height over the trough [tau]."""
    height = peak["k_f_work"] - trough["k_f_work"]
    return duration * (peak["k_f_work_std_error"] / (AVERAGED * height)) ** 2


def publish_peaks(tables, curves):
    """K_f at even and odd eta, and the time that averages it."""
    duration = 1000 if tables.quick else 20000
    rows = []
    for (kelvin, quality), curve_rows in curves.items():
        at_even = [at(curve_rows, eta) for eta in (2, 4, 6)]
        troughs = [at(curve_rows, eta) for eta in (3, 5, 7)]
        needed = max(averaging_time(at_even[2], trough, duration) for trough in troughs[1:])
        memory = quality / (2.0 * math.pi)  # in which a free spring forgets its energy [tau]: no mean is shorter
        rows.append([kelvin, quality or "no bath"] + ["%.3f" % row["k_f_work"] for row in at_even + troughs]
                    + [("%.2g" % needed if needed > memory else "below %.2g" % memory) if kelvin else ""])
    tables.write("thermal_even_odd", ("T / K", "Q", "eta = 2", "eta = 4", "eta = 6", "eta = 3", "eta = 5", "eta = 7",
                                      "averaging time / tau"), rows)


def maximum(rows):
    """Place and height of the peak: the vertex of a parabola through the five points about the greatest K_f.

    Each with its standard error, from the scatter of the points about the parabola or from their own errors, whichever
    is greater.
    """
    top = max(range(2, len(rows) - 2), key=lambda i: rows[i]["k_f_work"])
    near = rows[top - 2:top + 3]
    x = np.array([row["eta"] for row in near]) - rows[top]["eta"]
    y = np.array([row["k_f_work"] for row in near])
    powers = np.vander(x, 3)
    c, _, _, _ = np.linalg.lstsq(powers, y, rcond=None)
    scatter = np.sum((y - powers @ c) ** 2) / (len(x) - 3)
    variance = max(scatter, np.mean([row["k_f_work_std_error"] ** 2 for row in near]))
    covariance = variance * np.linalg.inv(powers.T @ powers)
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


def publish_maxima(tables):
    """Place, height and width of the first three peaks, on a fine grid about each."""
    duration, step = (500, 0.05) if tables.quick else (20000, 0.01)
    baths = [(0, 0)] + [(kelvin, quality) for quality in QUALITIES for kelvin in TEMPERATURES]
    rows = []
    for kelvin, quality in baths:
        bath = [] if quality == 0 else ["--quality-factor", quality, "--temperature", kelvin * KELVIN]
        for eta in (2, 4, 6):
            fine = tables.make("thermal_peak_%g_%g_%g" % (kelvin, quality, eta), "friction_curve", "--eta",
                               "%g:%g:%g" % (eta - 0.5, eta + 0.5, step), "--duration", duration, *bath)
            place, place_error, height, height_error = maximum(fine)
            half, half_error = width(fine, height)
            three = ((place, place_error), (height, height_error), (half, half_error))
            rows.append([kelvin, quality or "no bath", "%d" % (eta / 2)] + [
                "%.3f ± %.3f" % (value, math.ceil(1960 * error) / 1000) for value, error in three])
    tables.write("thermal_peaks", ("T / K", "Q", "peak", "at eta", "K_f / (m_tip/tau)", "width"), rows)


def measured(tables, eta, quality, theta, kicks, duration):
    """The row of K_f, and the time for each tau [us]."""
    name = "kicks_%g_%g_%g_%g" % (eta, quality, theta, kicks)
    row, = tables.make(name, "friction_curve", "--eta", eta, "--quality-factor", quality, "--temperature", theta,
                       "--kicks-per-tau", kicks, "--duration", duration, "--threads", 1)
    return row, tables.seconds(name) / duration * 1e6


def kick_rows(tables):
    """Error of K_f against the rate of kicks."""
    duration = 1000 if tables.quick else 100000
    rows = []
    for quality in (500, 20) if tables.quick else QUALITIES:
        for theta in (0, 0.926):
            for eta in (2,) if tables.quick else (1, 2, 3.4, 5, 6):
                truth, _ = measured(tables, eta, quality, theta, REFERENCE, duration)
                for kicks in GOLDEN[::3] if tables.quick else GOLDEN:
                    row, cost = measured(tables, eta, quality, theta, kicks, duration)
                    error = row["k_f_work"] - truth["k_f_work"]
                    noise = (row["k_f_work_std_error"] ** 2 + truth["k_f_work_std_error"] ** 2) ** 0.5
                    rows.append((eta, quality, theta, kicks, truth["k_f_work"], error / truth["k_f_work"],
                                 noise / truth["k_f_work"], cost))
    tables.write("thermal_kicks", ("eta", "quality_factor", "temperature", "kicks_per_tau", "k_f_work", "error",
                                     "std_error", "us_per_tau"), rows)
    return rows


def draw_kicks(axes, rows):
    marks = {500: "^", 100: "o", 20: "s"}
    colours = {1: style.PINK, 2: style.ORANGE, 3.4: style.BLUE, 5: style.GREEN, 6: style.YELLOW}
    for eta, quality in sorted({(row[0], row[1]) for row in rows}):
        for theta, fill in ((0, "none"), (0.926, "full")):
            some = [row for row in rows if row[:3] == (eta, quality, theta)]
            axes.plot([row[7] for row in some], [max(abs(row[5]), 1e-5) for row in some], marker=marks[quality],
                      color=colours[eta], fillstyle=fill, linewidth=0.5, markersize=5)
    for eta, colour in colours.items():
        axes.plot([], [], color=colour, label=r"$\eta$ = %g" % eta)
    for quality, mark in marks.items():
        axes.plot([], [], mark, color="black", label="Q = %g" % quality)
    axes.plot([], [], "o", color="black", fillstyle="none", label="0 K (full: 300 K)")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.axhline(0.005, color="black", linestyle=":", linewidth=1)
    axes.set_xlabel(r"time per $\tau$ / $\mu$s")
    axes.set_ylabel(r"error of $K_f$, relative to 123 kicks per $\tau$")
    axes.legend(fontsize=8, ncol=2, loc="upper right")


def draw_thermostats(axes, rows):
    looks = {("exact", float("inf")): ("exact motion between kicks", style.ORANGE, "*", "-"),
             ("baoab_penalty", 1.0): (r"BAOAB, penalty spring, $\omega_p h$ = 1", style.BLUE, "o", "-"),
             ("baoab_penalty", 0.25): (r"BAOAB, penalty spring, $\omega_p h$ = 1/4", style.BLUE, "o", ":"),
             ("euler_maruyama_penalty", 1.0): (r"Euler-Maruyama, $\omega_p h$ = 1", style.GREEN, "s", "-"),
             ("euler_maruyama_penalty", 0.25): (r"Euler-Maruyama, $\omega_p h$ = 1/4", style.GREEN, "s", ":")}
    for (method, stiffness), (label, colour, mark, line) in looks.items():
        some = [row for row in rows if (row["method"], row["stiffness"]) == (method, stiffness)]
        axes.errorbar([row["us_per_tau"] for row in some], [abs(row["bias"]) for row in some],
                      [1.96 * row["std_error"] for row in some], color=colour, marker=mark, label=label, linewidth=0.8,
                      linestyle=line, markersize=9 if mark == "*" else 5)
    axes.axvline(157.0, color="black", linestyle=":", linewidth=1)
    axes.text(150.0, 1.2e-4, "real time", rotation=90, ha="right", va="bottom")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 0.2)
    axes.set_xlabel(r"time per $\tau$ / $\mu$s")
    axes.set_ylabel(r"bias of $\langle (y - y_0)^2 \rangle$ at equilibrium, relative")
    axes.legend(fontsize=9)


def accuracy(tables):
    rows = kick_rows(tables)
    tables.make("thermal_real_time", "real_time", "--temperature", 0.926, "--quality-factor", 100, "--cutoff", 0.05,
                "--step", 1 if tables.quick else 0.05, "--tau", 100 if tables.quick else 5000)
    thermostats = tables.make("thermostats", "thermostats", "--seconds", 0.2 if tables.quick else 12)
    figure, (left, right) = style.new(13.0, 5.5, 1, 2)
    draw_kicks(left, rows)
    draw_thermostats(right, thermostats)
    return figure

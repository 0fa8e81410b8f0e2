"""FIG. 2-4: the attractor at eta = 3.4, its orbits, and what they tell of its friction."""
import math

import numpy as np
from matplotlib.colors import LogNorm

from registry import picture, table

from . import paths, style

ETA, GAMMA, CUTOFF = 3.4, 0.7, 0.05


def multipliers(row):
    """The expanding ones, as text; of a complex pair one."""
    expanding = [complex(row["multiplier_%d_re" % i], row["multiplier_%d_im" % i]) for i in range(1, 5)]
    return ", ".join("%.4g" % m.real if m.imag == 0 else "%.3f +- %.3f i" % (m.real, m.imag)
                     for m in expanding if abs(m) > 1 and m.imag >= 0)


@table("periodic_orbits")
def friction_orbits(tables):
    return (["impacts", "cells", "K_f [m_tip/tau]", "expanding multipliers"],
            [(int(row["length"]), int(row["cells"]), "%.12g" % row["k_f"], multipliers(row))
             for row in tables.rows("periodic_orbits") if row["length"] <= 6])


AVERAGES = ["impacts in the longest orbit", "K_f, zeta function", "K_f, determinant", "1/zeta(1), should be 0",
            "determinant at 1, should be 0"]


@table("cycle_averages")
def friction_averages(tables):
    at = {(row["method"], int(row["order"])): row for row in tables.rows("cycle_averages")}
    return (AVERAGES,
            [(n, at["zeta", n]["k_f"], at["determinant", n]["k_f"], at["zeta", n]["conservation"],
              at["determinant", n]["conservation"])
             for n in sorted(order for method, order in at if method == "zeta")])


@picture()
def fig2_attractor(_):
    """Every flight is moved by whole cells to begin in the first."""
    _, start = paths.flights([0.53, 0.0, 3.2, 2.1], ETA, GAMMA, CUTOFF, 30)
    drawn, _ = paths.flights(start, ETA, GAMMA, CUTOFF, 250)
    figure, axes = style.new(3.9)
    for xs, ys in drawn:
        axes.plot(xs, ys, color=style.BLUE, linewidth=0.4, alpha=0.6)
    paths.draw_surface(axes, 0.0, 4.0)
    axes.set_ylim(-0.15, None)
    axes.set_xlabel("position x [a]; every flight is moved by whole cells, so that it begins in the first")
    axes.set_ylabel("height y [a]")
    return figure


def draw_orbit(axes, row, colour):
    drawn, _ = paths.flights([row[key] for key in paths.STATE], ETA, GAMMA, CUTOFF, int(row["length"]))
    offset = 0.0
    for xs, ys in drawn:
        axes.plot([x + offset for x in xs], ys, color=colour, linewidth=1.4)
        axes.plot([xs[0] + offset], [ys[0]], "o", color=colour, markersize=4)
        offset += math.floor(xs[-1])
    paths.draw_surface(axes, 0.0, max(2.0, row["cells"]) + 1.0)
    multiplier = complex(row["multiplier_1_re"], row["multiplier_1_im"])
    axes.set_title(r"%d impact%s in %d cells, $K_f$ = %.4f $m_{tip}/\tau$, $|\Lambda_1|$ = %.3g"
                   % (row["length"], "s" if row["length"] > 1 else "", row["cells"], row["k_f"], abs(multiplier)),
                   loc="left")
    axes.set_ylabel("y [a]")


@picture("periodic_orbits")
def fig3_orbit(tables):
    rows = [row for row in tables.rows("periodic_orbits") if row["length"] <= 6 and row["cells"] > 1]
    figure, axes = style.new(1.75 * len(rows), len(rows), 1)
    for ax, row in zip(axes, rows):
        draw_orbit(ax, row, style.ORANGE if row["length"] == 1 else style.BLUE)
    axes[-1].set_xlabel("position x [a]")
    return figure


def section(state):
    """Phase, extension, u and gap rate just after an impact [a, a/tau]: in these returns are measured."""
    phase, extension, u, w = state
    return np.array([phase, extension, u, w - paths.slope(phase) * u])


def attractor_box():
    """The least and the largest value of each coordinate of the section in 100000 impacts."""
    tips, transient, impacts = 100, 1000, 1000  # choices: the rare impacts at its edges differ from run to run
    state = [np.linspace(0.5, 0.6, tips), np.zeros(tips), np.full(tips, ETA), np.full(tips, 0.5 * (1.0 + ETA))]
    runs = []
    for i in range(transient + impacts):
        _, state = paths.next_impact(state, ETA, GAMMA, CUTOFF)
        if i >= transient:
            runs.append(section(state))
    return np.min(runs, axis=(0, 2)), np.max(runs, axis=(0, 2))


def nearest_returns(points, depth):
    """Phase, w and distance of the nearest return after two impacts, over extension and u, at each phase and gap rate.
    Distances are in sides of the attractor's box. Without a return there is no row."""
    low, high = attractor_box()
    grid = [low[k] + (high - low)[k] * (np.arange(n) + 0.5) / n for k, n in enumerate((points, depth, depth, points))]
    for phase in grid[0]:
        extension, u, rate = (axis.reshape(-1, points) for axis in np.meshgrid(*grid[1:], indexing="ij"))
        start = [np.full_like(u, phase), extension, u, rate + paths.slope(phase) * u]
        first, middle = paths.next_impact(start, ETA, GAMMA, CUTOFF, on_error="nan")
        second, end = paths.next_impact(middle, ETA, GAMMA, CUTOFF, on_error="nan")
        difference = section(end) - section(start)
        difference[0] -= np.round(difference[0])
        distance = np.linalg.norm(difference / (high - low)[:, None, None], axis=0)
        # bounces without speed come back at once; without an impact all is NaN
        distance[~(ETA * (first["dt"] + second["dt"]) >= 0.5)] = np.inf
        for column, best in enumerate(distance.argmin(axis=0)):
            if np.isfinite(distance[best, column]):
                yield phase, start[3][best, column], distance[best, column]


@picture("periodic_orbits")
def fig4_scan(tables):
    points, depth = (30, 10) if tables.quick else (120, 30)
    phase, w, distance = zip(*nearest_returns(points, depth))
    figure, axes = style.new(5.4)
    image = axes.scatter(phase, w, c=np.minimum(distance, 1.0), cmap="viridis", norm=LogNorm(0.02, 1.0),
                         s=(350.0 / points) ** 2 * 1.6, marker="s", linewidths=0)
    bar = figure.colorbar(image, ticks=[0.02, 0.05, 0.1, 0.2, 0.5, 1.0],
                          label="distance from a state to the state two impacts later\n"
                                "[ranges of the coordinates on the attractor]")
    bar.ax.set_yticklabels(["0.02", "0.05", "0.1", "0.2", "0.5", "1"])
    point = [row for row in tables.rows("periodic_orbits") if row["length"] == 1 and row["cells"] == 2][0]
    axes.plot([point["phase"]], [point["w"]], "o", markerfacecolor="none", markeredgecolor=style.ORANGE, markersize=15,
              markeredgewidth=2)
    axes.annotate("the orbit of one impact,\ntaken twice", (point["phase"], point["w"]), xytext=(0.33, 4.6),
                  color=style.ORANGE, ha="left", va="bottom",
                  arrowprops=dict(arrowstyle="-", color=style.ORANGE, shrinkB=9))
    axes.set(xlabel="surface phase of the impact [a]", ylabel=r"vertical velocity w after the impact [$a/\tau$]")
    return figure


@picture("friction_averages", "direct")
def fig5_averages(tables):
    rows, direct = tables.rows("friction_averages"), tables.rows("direct")[0]
    figure, axes = style.new(4.3, 1, 2)
    order = [row[AVERAGES[0]] for row in rows]
    for k_f, conserved, colour, marker, fill, label in (
            (AVERAGES[1], AVERAGES[3], style.BLUE, "o", {}, "zeta function"),
            (AVERAGES[2], AVERAGES[4], style.GREEN, "s", style.OPEN, "determinant")):
        axes[0].plot(order, [row[k_f] for row in rows], marker + "-", color=colour, label=label, **fill)
        axes[1].plot(order, [abs(row[conserved]) for row in rows], marker + "-", color=colour, label=label, **fill)
    axes[0].axhspan(direct["k_f"] - 1.96 * direct["k_f_std_error"], direct["k_f"] + 1.96 * direct["k_f_std_error"],
                    color=style.ORANGE, label="direct simulation, 95 %")
    axes[0].set_ylabel(style.K_F_LABEL)
    axes[1].set(ylabel=r"lack of conservation, 0 if exact: $|1/\zeta(1)|$, $|\det|$", yscale="log")
    for ax in axes:
        ax.set_xlabel("impacts in the longest orbit used")
        ax.set_xticks(range(1, 11))
        style.legend_above(ax)
    return figure

"""FIG. 2-4: the attractor at eta = 3.4, its orbits, and what they tell of its friction."""
import math

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


@table("cycle_averages")
def friction_averages(tables):
    at = {(row["method"], int(row["order"])): row for row in tables.rows("cycle_averages")}
    return (["impacts in the longest orbit", "K_f, zeta function", "K_f, determinant", "1/zeta(1), should be 0",
             "determinant at 1, should be 0"],
            [(n, at["zeta", n]["k_f"], at["determinant", n]["k_f"], at["zeta", n]["conservation"],
              at["determinant", n]["conservation"])
             for n in sorted(order for method, order in at if method == "zeta")])


@picture()
def fig2_attractor(_):
    """Every flight is moved by whole cells to begin in the first."""
    _, start = paths.flights([0.53, 0.0, 3.2, 2.1], ETA, GAMMA, CUTOFF, 30)
    drawn, _ = paths.flights(start, ETA, GAMMA, CUTOFF, 250)
    figure, axes = style.new(9.0, 4.5)
    for xs, ys in drawn:
        axes.plot(xs, ys, color=style.BLUE, linewidth=0.4, alpha=0.6)
    paths.draw_surface(axes, 0.0, 4.0)
    axes.set_ylim(-0.15, None)
    axes.set_xlabel("x / a, flights begun in the first cell")
    axes.set_ylabel("y / a")
    axes.set_title(r"FIG. 2: 250 flights on the chaotic attractor, $\eta$ = 3.4, $\gamma$ = 0.7")
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
    axes.set_title(r"%d impact%s, $K_f$ = %.6f $m_{tip}/\tau$, largest multiplier %.3g in size"
                   % (row["length"], "s" if row["length"] > 1 else "", row["k_f"], abs(multiplier)), fontsize=10)
    axes.set_ylabel("y / a")


@picture("periodic_orbits")
def fig3_orbit(tables):
    rows = [row for row in tables.rows("periodic_orbits") if row["length"] <= 6 and row["cells"] > 1]
    figure, axes = style.new(9.0, 1.9 * len(rows), len(rows), 1)
    for ax, row in zip(axes, rows):
        draw_orbit(ax, row, style.ORANGE if row["length"] == 1 else style.BLUE)
    axes[-1].set_xlabel("x / a")
    figure.suptitle(r"FIG. 3: the paper's orbit, and all others up to six impacts on its attractor")
    return figure


@picture("return_scan", "periodic_orbits")
def fig4_scan(tables):
    rows = tables.rows("return_scan")
    points = 30 if tables.quick else 120
    figure, axes = style.new(8.0, 5.5)
    finite = [min(row["distance"], 1.0) for row in rows]
    image = axes.scatter([row["phase"] for row in rows], [row["w"] for row in rows], c=[math.log10(d) for d in finite],
                         cmap="viridis", s=1000.0 / points * 2.2, marker="s", linewidths=0, vmax=0)
    figure.colorbar(image, label=r"$\log_{10}$ of the distance after two impacts, in parts of the box")
    point = [row for row in tables.rows("periodic_orbits") if row["length"] == 1 and row["cells"] == 2][0]
    axes.plot([point["phase"]], [point["w"]], "o", markerfacecolor="none", markeredgecolor=style.ORANGE, markersize=14,
              markeredgewidth=2, label="the orbit of one impact, twice")
    axes.legend(loc="lower right")
    axes.set_xlabel("surface phase of the impact")
    axes.set_ylabel(r"w after it / (a/$\tau$)")
    axes.set_title(r"FIG. 4: nearest returns after two impacts, $\eta$ = 3.4, $\gamma$ = 0.7")
    return figure


@picture("cycle_averages", "direct")
def fig5_averages(tables):
    rows, direct = tables.rows("cycle_averages"), tables.rows("direct")[0]
    figure, axes = style.new(10.0, 4.2, 1, 2)
    for method, colour, marker in (("zeta", style.BLUE, "o"), ("determinant", style.GREEN, "s")):
        some = [row for row in rows if row["method"] == method]
        axes[0].plot([row["order"] for row in some], [row["k_f"] for row in some], marker=marker, color=colour,
                     label=method)
        axes[1].plot([row["order"] for row in some], [abs(row["conservation"]) for row in some], marker=marker,
                     color=colour,
                     label=method)
    axes[0].axhspan(direct["k_f"] - 1.96 * direct["k_f_std_error"], direct["k_f"] + 1.96 * direct["k_f_std_error"],
                    color=style.ORANGE, label="direct simulation, 95 %")
    axes[0].set_ylabel(style.K_F_LABEL)
    axes[1].set_ylabel("what flow conservation is missed by")
    axes[1].set_yscale("log")
    for ax in axes:
        ax.set_xlabel("impacts in the longest orbit used")
        ax.legend(fontsize=9)
    figure.suptitle(r"$K_f$ from periodic orbits, $\eta$ = 3.4, $\gamma$ = 0.7")
    return figure

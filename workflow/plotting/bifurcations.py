"""Orbits followed to where they are born and die, and the attractors along the way."""
import numpy as np

from commands import BRANCHES
from registry import picture

from . import style

EVENTS = {"period doubling": (style.PINK, "--"), "torus": (style.GREEN, "-."), "saddle-node": (style.AMBER, ":"),
          "grazing": ("black", "-"), "corner": (style.GREY, (0, (1, 3)))}


def branch(tables, name):
    """The points and the events of the branch with the most friction."""
    rows = tables.rows(name)
    best = max(rows, key=lambda row: row["k_f"] if not row["event"] else 0)["orbit"]
    rows = [row for row in rows if row["orbit"] == best]
    return [row for row in rows if not row["event"]], [row for row in rows if row["event"] in EVENTS]


@picture("even_orbit_gamma", "even_basins")
def fig6_even_orbit(tables):
    points, events = branch(tables, "even_orbit_gamma")
    rows = tables.rows("even_basins")
    grazing = next(row["value"] for row in events if row["event"] == "grazing")
    figure, axes = style.new(5.6, 2, 1, sharex=True)
    others = [r for r in rows if not same_orbit(r)]
    axes[0].plot([r["gamma"] for r in others], [r["k_f"] for r in others], "s", color=style.ORANGE, markersize=4,
                 label="other attractors", **style.OPEN)
    own = [r for r in rows if same_orbit(r)]
    axes[0].plot([r["gamma"] for r in own], [r["k_f"] for r in own], "o", color=style.BLUE, markersize=4,
                 label="starts that end on the orbit")
    axes[0].plot([p["value"] for p in points], [p["k_f"] for p in points], color="black", linewidth=1.1,
                 label="the orbit, followed from $\\gamma$ = 0.7 down")
    axes[0].set_ylabel(style.K_F_LABEL)
    style.legend_above(axes[0])
    axes[1].errorbar([r["gamma"] for r in own], [r["basin"] for r in own], [1.96 * r["basin_std_error"] for r in own],
                     color=style.BLUE, marker="o", markersize=4, linewidth=0.8)
    axes[1].set(ylabel="share of 200 random starts\nthat end on the orbit", xlabel=r"restitution $\gamma$",
                ylim=(-0.03, 1.05))
    for ax in axes:
        ax.axvline(grazing, color="black", linestyle=":", linewidth=1.2)
    axes[0].text(grazing - 0.004, axes[0].get_ylim()[1] * 0.93, "the orbit\ngrazes a crest", ha="right", va="top")
    return figure


def same_orbit(row):
    return row["attractor"] == "period-1" and abs(row["k_f"] / style.closed_form(row["gamma"]) - 1) < 1e-6


FEW, NEAR = 12, 0.02  # values of a periodic orbit at most; [a/tau] between two that are the same


def distinct(values):
    """The values without those that lie near another."""
    found = []
    for value in sorted(values):
        if not found or value - found[-1] > NEAR:
            found.append(value)
    return found


def alike(one, other):
    """Whether two sweeps are on one attractor: two periodic orbits by their values; all chaos counts as one."""
    a, b = distinct(one), distinct(other)
    if len(a) > FEW and len(b) > FEW:
        return True
    return len(a) == len(b) and all(abs(x - y) < 2 * NEAR for x, y in zip(a, b))


def carried(vary, values):
    """The normal speeds of the impacts at each value. One tip is carried from value to value."""
    import afm  # the other figures do without
    # [tau], and how many are drawn. Choices: after 800 tau chaos that dies out still showed near gamma = 0.92
    transient, measured, impacts = 2000, 200, 60
    tip = afm.Tip(afm.Model(gamma=0.7, cutoff=0.05), eta=3.4)
    speeds = {}
    for value in values:
        if vary == "gamma":
            tip.change(gamma=value)
        else:
            tip.drag(value)
        tip.advance(float(tip.now) + transient)
        events = tip.advance(float(tip.now) + measured)
        speeds[value] = events["normal_speed"][events["kind"] == afm.Kind.IMPACT][:impacts]
    return speeds


def diagram(tables, axes, name):
    """A parameter carried up and down: where the two sweeps differ attractors coexist."""
    vary, bounds, branches = BRANCHES[name]
    events = [event for index in range(len(branches)) for event in branch(tables, "%s_branch_%d" % (name, index))[1]]
    values = np.linspace(*bounds, 61 if tables.quick else 601)
    speeds = {"up": carried(vary, values), "down": carried(vary, values[::-1])}
    same = {at for at in values if alike(speeds["up"][at], speeds["down"][at])}
    dot = dict(linestyle="none", marker="o", markersize=0.9, markeredgewidth=0)
    for sweep, colour in (("down", style.ORANGE), ("up", style.BLUE)):
        rows = [(at, speed) for at, some in speeds[sweep].items() for speed in some if at not in same]
        if rows:
            axes.plot(*zip(*rows), color=colour, zorder=3, **dot)
    both = [(at, speed) for at in same for speed in speeds["up"][at]]
    axes.plot(*zip(*both), color="#777777", **dot)
    for event in events:
        if bounds[0] <= event["value"] <= bounds[1]:
            colour, line = EVENTS[event["event"]]
            axes.axvline(event["value"], color=colour, linestyle=line, linewidth=1.2, label=event["event"])
    axes.set(xlim=bounds, ylim=(0, None), ylabel=r"normal speed of impacts [$a/\tau$]")
    axes.grid(False)


@picture(*("%s_branch_%d" % (name, i) for name, (_, _, branches) in BRANCHES.items() for i in range(len(branches))))
def fig8_bifurcations(tables):
    figure, axes = style.new(8.4, 3, 1)
    for ax, name in zip(axes, BRANCHES):
        diagram(tables, ax, name)
    for ax, label in zip(axes, (style.ETA_LABEL, style.ETA_LABEL, r"restitution $\gamma$, at $\eta$ = 3.4")):
        ax.set_xlabel(label)
    lines = {line.get_label(): line for ax in axes.flat for line in ax.lines if line.get_label() in EVENTS}
    for label, colour in (("both sweeps", "#777777"), ("rising only", style.BLUE), ("falling only", style.ORANGE)):
        lines[label] = axes[0].plot([], [], "o", color=colour, markersize=4)[0]
    style.legend_of_all(figure, lines, len(lines))
    return figure

"""Orbits followed to where they are born and die, and the attractors along the way."""
from commands import BRANCHES
from registry import picture

from . import style

EVENTS = {"period doubling": (style.ORANGE, "--"), "torus": (style.GREEN, "-."), "saddle-node": (style.PINK, ":"),
          "grazing": ("black", "-"), "corner": (style.GREY, (0, (1, 3)))}


def branch(tables, name):
    """Points and events of the branches with the most friction."""
    rows = tables.rows(name)
    best = max(rows, key=lambda row: row["k_f"] if not row["event"] else 0)["orbit"]
    rows = [row for row in rows if row["orbit"] == best]
    points = [row for row in rows if not row["event"]]
    return points, [row for row in rows if row["event"] in EVENTS]


def mark(axes, events, seen):
    for row in events:
        colour, line = EVENTS[row["event"]]
        axes.axvline(row["value"], color=colour, linestyle=line, linewidth=1.2,
                     label=row["event"] if row["event"] not in seen else None)
        seen.add(row["event"])


@picture("even_orbit_gamma", "even_basins")
def fig6_even_orbit(tables):
    points, events = branch(tables, "even_orbit_gamma")
    rows = tables.rows("even_basins")
    figure, axes = style.new(9.0, 7.5, 3, 1, sharex=True)
    axes[0].plot([p["value"] for p in points], [p["k_f"] for p in points], color=style.BLUE,
                 label="the orbit, continued")
    colours = {"periodic": style.SKY, "quasi-periodic": style.GREEN, "chaotic": style.ORANGE}
    for kind, colour in colours.items():
        some = [r for r in rows if r["attractor"].startswith("period-" if kind == "periodic" else kind)]
        axes[0].scatter([r["gamma"] for r in some], [r["k_f"] for r in some], s=[4 + 30 * r["basin"] for r in some],
                        color=colour, label="attractors: " + kind, zorder=0)
    axes[0].set_ylabel(style.K_F_LABEL)
    axes[1].plot([p["value"] for p in points], [p["clearance"] for p in points], color=style.BLUE)
    axes[1].set_ylabel("smallest gap\non the way / a")
    axes[1].axhline(0.0, color=style.GREY, linewidth=0.8)
    axes[1].set_ylim(-0.002, 0.035)
    own = [r for r in rows if r["attractor"] == "period-1" and abs(r["k_f"] / style.closed_form(r["gamma"]) - 1) < 1e-6]
    axes[2].errorbar([r["gamma"] for r in own], [r["basin"] for r in own], [1.96 * r["basin_std_error"] for r in own],
                     color=style.BLUE, marker="o", markersize=3, linewidth=0.8)
    axes[2].set_ylabel("share of starts that\nend on this orbit")
    axes[2].set_xlabel(r"restitution $\gamma$")
    for ax in axes:
        mark(ax, events, set())
    axes[0].legend(fontsize=8)
    axes[0].set_title(r"The orbit of two impacts per $\tau$ at $\eta$ = 2, down to where it grazes")
    return figure


def diagram(tables, row, name):
    """A parameter carried up (left) and down (right): where the two differ attractors coexist."""
    vary, bounds, _, branches = BRANCHES[name]
    events = [event for index in range(len(branches)) for event in branch(tables, "%s_branch_%d" % (name, index))[1]
              if bounds[0] <= event["value"] <= bounds[1]]
    for axes, sweep, colour in zip(row, ("up", "down"), (style.BLUE, style.ORANGE)):
        rows = tables.rows("%s_%s" % (name, sweep))
        axes.plot([r[vary] for r in rows], [r["normal_speed"] for r in rows], ",", color=colour, alpha=0.6)
        mark(axes, events, set())
        axes.set_xlim(*bounds)
        axes.set_ylim(0, None)
    row[0].set_ylabel(r"normal speed [a/$\tau$]")


DIAGRAMS = tuple(name + ending for name, (_, _, _, branches) in BRANCHES.items()
                 for ending in ["_up", "_down"] + ["_branch_%d" % i for i in range(len(branches))])


@picture(*DIAGRAMS)
def fig8_bifurcations(tables):
    figure, axes = style.new(11.0, 9.5, 3, 2, sharey="row")
    for row, name in zip(axes, BRANCHES):
        diagram(tables, row, name)
    for row, label in zip(axes, (style.ETA_LABEL, style.ETA_LABEL, r"restitution $\gamma$ at $\eta$ = 3.4")):
        for ax in row:
            ax.set_xlabel(label)
    for ax, direction in zip(axes[0], ("raised", "lowered")):
        ax.set_title("parameter slowly " + direction)
    lines = {line.get_label(): line for ax in axes.flat for line in ax.lines if line.get_label() in EVENTS}
    figure.suptitle(" \n")  # room for the legend
    figure.legend(lines.values(), lines.keys(), loc="upper center", ncol=len(lines), frameon=False)
    return figure

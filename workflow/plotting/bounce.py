"""One bounce of the tip: the flights before and after it, the velocities, the gap, the time to the next impact.

Two calls of afm.next_impact() give the impacts; between them the tip flies by the exact formula (Eq. 9-10).
"""
import math

from registry import picture

from . import style
from .paths import at, draw_surface, next_impact, slope, surface

SCENE, START = (3.4, 0.7, 0.05), (0.25, 0.0, 3.4, 1.0)  # eta, gamma, cutoff; the state after the impact before
GAP_AGREES = 1e-12  # [a] the impacts lie on the surface that is drawn

# line styles that need no colour
BEFORE = dict(color=style.BLUE, linestyle=(0, (4, 1.5)), linewidth=2.2)
AFTER = dict(color=style.ORANGE, linestyle="-", linewidth=2.2)
SURFACE = dict(color="#444444", linewidth=1.5)
NORMAL_COLOUR = style.GREEN
DT = r"$\Delta t$"


class Flight:
    """From one impact to the next; units a and tau, x along the surface from a crest."""

    def __init__(self, state, cell):
        self.state, self.cell = state, cell
        self.row, self.state_after = next_impact(state, *SCENE)
        self.x = cell + state[0]
        if not abs(self.gaps()[-1]) < GAP_AGREES:
            raise SystemExit("bounce: the flight ends %g a off the surface" % self.gaps()[-1])

    def at(self, t):
        """Position and velocity in the lab, t after the start."""
        x, y, u, w = at(self.state, SCENE[0], t)
        return self.cell + x, y, u, w

    def times(self, points=400):
        return [self.row["dt"] * i / points for i in range(points + 1)]

    def path(self):
        return list(zip(*(self.at(t)[:2] for t in self.times())))

    def gaps(self):
        return [y - surface(x) for x, y, _, _ in map(self.at, self.times())]

    def next(self):
        """The flight after the impact that ends this one."""
        return Flight(self.state_after, round(self.at(self.row["dt"])[0] - self.state_after[0]))


def draw_flights(axes, before, after):
    bottom, stretch = -0.17, 2
    xs = before.path()[0] + after.path()[0]
    draw_surface(axes, min(xs) - 0.3, max(xs) + 0.3, bottom)
    axes.plot(*before.path(), **BEFORE)
    axes.plot(*after.path(), **AFTER)
    end = after.at(after.row["dt"])
    axes.plot([before.x, after.x, end[0]], [surface(before.x), surface(after.x), end[1]], "o", color="black")
    axes.set_ylim(bottom, max(before.path()[1] + after.path()[1]) + 0.13)
    axes.set_aspect(stretch)
    axes.set_title(r"Two flights between three impacts, $\eta$ = %g (heights drawn %d times larger)" % (before.row["eta"], stretch),
                   loc="left")
    axes.set(xlabel="position x [a]", ylabel="height y [a]")
    for flight, look in ((before, BEFORE), (after, AFTER)):
        x, y = max(zip(*flight.path()), key=lambda point: point[1])
        axes.annotate(DT + r" = %.4f $\tau$" % flight.row["dt"], (x, y), xytext=(0, 7), textcoords="offset points",
                      ha="center", va="bottom", color=look["color"])
    mark_gap(axes, after)


def mark_gap(axes, flight):
    x, y, _, _ = flight.at(0.72 * flight.row["dt"])
    axes.annotate("", (x, y), xytext=(x, surface(x)), arrowprops=dict(arrowstyle="<->", shrinkA=0, shrinkB=0))
    axes.annotate("gap", (x, 0.6 * surface(x) + 0.4 * y), xytext=(-6, 0), textcoords="offset points",
                  ha="right", va="center")


def arrow(axes, start, vector, label, colour, at, offset):
    """Labelled at its head or its tail, whichever is away from the impact."""
    end = (start[0] + vector[0], start[1] + vector[1])
    axes.annotate("", end, xytext=start,
                  arrowprops=dict(arrowstyle="-|>", color=colour, linewidth=2.5, shrinkA=0, shrinkB=0,
                                  mutation_scale=18))
    axes.annotate(label, end if at == "head" else start, xytext=offset, textcoords="offset points", color=colour,
                  ha="center", va="center")


def draw_velocities(axes, before, after):
    row, scale = before.row, 0.045
    x, y, u, w = before.at(row["dt"])
    root = math.hypot(1.0, slope(x))
    normal = (-slope(x) / root, 1.0 / root)
    draw_surface(axes, x - 0.30, x + 0.24, y - 0.11)
    axes.set_ylim(y - 0.11, y + 0.25)
    axes.set_aspect(1)
    axes.plot(*before.path(), **dict(BEFORE, linewidth=1.2))
    axes.plot(*after.path(), **dict(AFTER, linewidth=1.2))
    arrow(axes, (x, y), tuple(0.2 * part for part in normal), r"$\mathbf{n}$", NORMAL_COLOUR, "head", (-9, -1))
    v, v_after = (scale * u, scale * w), (scale * after.row["u"], scale * after.row["w"])
    arrow(axes, (x - v[0], y - v[1]), v, r"$\mathbf{v}$", BEFORE["color"], "tail", (0, 12))
    arrow(axes, (x, y), v_after, r"$\mathbf{v}'$", AFTER["color"], "head", (11, 0))
    axes.plot([x], [y], "o", color="black", zorder=5)
    axes.set_title("The impact in true proportions", loc="left")
    axes.grid(False)
    axes.set_xlabel(r"normal speed $|\mathbf{n}\cdot\mathbf{v}|$ = %.3f $a/\tau$, energy lost %.3f $m_{tip}\,a^2/\tau^2$"
                    % (row["normal_speed"], row["energy_loss"]))
    axes.set_xticks([])
    axes.set_yticks([])


def draw_gap(axes, before, after):
    axes.axhline(0.0, **SURFACE)
    axes.plot([t - before.row["dt"] for t in before.times()], before.gaps(), **BEFORE)
    axes.plot(after.times(), after.gaps(), **AFTER)
    axes.plot([-before.row["dt"], 0.0, after.row["dt"]], [0.0] * 3, "o", color="black")
    axes.set_ylim(bottom=-0.03)
    axes.set_title("The gap between tip and surface", loc="left")
    axes.set(xlabel=r"time since the impact [$\tau$]", ylabel="gap [a]")


@picture()
def bounce(_):
    before = Flight(START, 0)
    after = before.next()
    figure = style.figure(7.2)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.0), height_ratios=(1.0, 1.05))
    draw_flights(figure.add_subplot(grid[0, :]), before, after)
    draw_velocities(figure.add_subplot(grid[1, 0]), before, after)
    draw_gap(figure.add_subplot(grid[1, 1]), before, after)
    return figure

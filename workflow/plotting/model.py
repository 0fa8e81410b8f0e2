"""docs/model.md: the setup, the restitution law, the friction force in SI, and mica's values in SI."""
import math

from registry import picture, table

from . import style
from .friction import SWEPT, swept

OMEGA_V, OMEGA_H, TIP_MASS, LATTICE, AMPLITUDE = 40e3, 250e3, 408e-12, 0.52e-9, 0.05e-9  # SI, the paper's section V
TAU = style.TWO_PI / OMEGA_V
BOLTZMANN = 1.380649e-23  # [J/K]
HOLDER, TIP, HIT = (0.28, 0.13), (0.72, 0.58), 1.80  # [a] where the drawing has the holder, the tip, and an impact
HEIGHT = 0.22  # [a] of the drawn surface, more than twice mica's


def surface(x):
    return HEIGHT * math.cos(style.TWO_PI * x)


def spring(axes, begin, end, turns=7, width=0.035):
    """A zigzag between two points."""
    (x0, y0), (x1, y1) = begin, end
    length = math.hypot(x1 - x0, y1 - y0)
    along, across = ((x1 - x0) / length, (y1 - y0) / length), (-(y1 - y0) / length, (x1 - x0) / length)
    steps = [0.0, 0.12] + [0.12 + 0.76 * (i + 0.5) / (2 * turns) for i in range(2 * turns)] + [0.88, 1.0]
    sides = [0, 0] + [(-1) ** i for i in range(2 * turns)] + [0, 0]
    points = [(x0 + s * length * along[0] + width * k * across[0], y0 + s * length * along[1] + width * k * across[1])
              for s, k in zip(steps, sides)]
    axes.plot(*zip(*points), color=style.GREY, linewidth=1.3)


def arrow(axes, begin, end, text="", at=None, colour="black", both=False):
    axes.annotate("", end, xytext=begin, arrowprops=dict(arrowstyle="<->" if both else "-|>", color=colour, shrinkA=0,
                                                         shrinkB=0, linewidth=1.4))
    if text:
        axes.text(*at, text, color=colour, ha="center", va="center")


def draw_lengths(axes):
    arrow(axes, (0, -0.42), (1, -0.42), "lattice spacing $a$", (0.5, -0.48), both=True)
    for x in (0, 1):
        axes.plot([x, x], [surface(x), -0.46], ":", color=style.GREY, linewidth=0.8)
    arrow(axes, (2.0, 0), (2.0, HEIGHT), "amplitude\n$H$", (2.17, 0.5 * HEIGHT), both=True)
    axes.plot([-0.35, 2.12], [0, 0], "--", color=style.GREY, linewidth=0.8)
    axes.text(2.14, -0.03, "mid-surface, $y = 0$", va="center")
    x, y = TIP
    arrow(axes, (x + 0.07, surface(x + 0.07)), (x + 0.07, y), "gap $g = y - h(x)$", (x + 0.35, 0.36), both=True)


def draw_holder(axes):
    (xc, y0), (x, y) = HOLDER, TIP
    spring(axes, (xc, y), (x, y))
    spring(axes, (x, y0), (x, y), turns=6, width=0.03)
    axes.plot([xc, xc, x + 0.04], [y + 0.1, y0, y0], color=style.ORANGE, linewidth=2.2)
    axes.plot(xc, y0, "o", color=style.ORANGE, markersize=8)
    axes.text(xc - 0.04, y0 + 0.16, "holder,\nat $(x_c, y_0)$", color=style.ORANGE, ha="right", va="bottom")
    arrow(axes, (xc, y + 0.1), (xc + 0.26, y + 0.1), "$v_0$", (xc + 0.31, y + 0.1), style.ORANGE)
    arrow(axes, (xc + 0.08, 0), (xc + 0.08, y0), "$y_0$", (xc + 0.14, 0.5 * y0), both=True)
    axes.text(0.5 * (xc + x) + 0.02, y - 0.06, r"$k_h = m\,\omega_h^2$", ha="center", va="top")
    axes.text(x - 0.05, 0.24, r"$k_v = m\,\omega_v^2$", ha="right", va="center")
    axes.plot(x, y, "o", color=style.BLUE, markersize=13)
    axes.text(x + 0.05, y + 0.05, "tip of mass $m$, at $(x, y)$", color=style.BLUE)


def draw_impact(axes):
    slope = -HEIGHT * style.TWO_PI * math.sin(style.TWO_PI * HIT)
    size, y = math.hypot(1.0, slope), surface(HIT)
    arrow(axes, (HIT, y), (HIT - 0.26 * slope / size, y + 0.26 / size), r"$\mathbf{n}$", (HIT - 0.19, y + 0.25),
          style.GREEN)
    arrow(axes, (HIT, y), (HIT + 0.22 / size, y + 0.22 * slope / size), r"$\mathbf{t}$", (HIT + 0.06, y + 0.2),
          style.GREEN)


@picture()
def model_setup(_):
    figure, axes = style.new(4.7)
    xs = [-0.35 + 2.47 * i / 600 for i in range(601)]
    ys = [surface(x) for x in xs]
    axes.fill_between(xs, ys, -0.55, color=style.SOLID)
    axes.plot(xs, ys, color=style.GREY, linewidth=1.5)
    axes.text(1.2, -0.4, r"rigid surface  $h(x) = H\,\cos(2\pi x/a)$", ha="left")
    draw_lengths(axes)
    draw_holder(axes)
    draw_impact(axes)
    for end, name, at in (((1.92, 0.56), "$x$, along the drag", (2.15, 0.56)),
                          ((1.7, 0.78), "$y$, away from the surface", (1.72, 0.83))):
        arrow(axes, (1.7, 0.56), end, name, at)
    axes.set(xlim=(-0.37, 2.5), ylim=(-0.55, 0.88))
    style.bare(axes)
    return figure


@picture()
def model_restitution(_):
    figure, axes = style.new(3.4)
    for gamma, colour, line in ((0.7, style.BLUE, "-"), (0.5, style.ORANGE, "--")):
        axes.plot([0, 1, 2.5], [1, gamma, gamma], line, color=colour, linewidth=2)
        axes.text(2.2, gamma + 0.03, r"$\gamma$ = %g" % gamma, color=colour)
    axes.axvline(1, color=style.GREY, linewidth=0.8, linestyle=":")
    axes.set(xlabel=r"normal speed before the impact, $|\mathbf{n}\cdot\mathbf{v}|$ [$v_c$]",
             ylabel=r"effective restitution $\gamma_{eff}$", xlim=(0, 2.5), ylim=(0, 1.08))
    return figure


@picture(*SWEPT)
def model_force(tables):
    """The tables of FIG. 1, as a force in nN against a speed in um/s."""
    figure, axes = style.new(4.6)
    speed, unit = LATTICE / TAU, TIP_MASS * LATTICE / TAU ** 2  # of eta [m/s], of a force [N]
    for direction, line in style.SWEEPS.items():
        rows = swept(tables, direction)
        axes.plot([1e6 * speed * row["eta"] for row in rows],
                  [1e9 * unit * row["k_f_work"] * row["eta"] for row in rows], **line)
    even = range(2, 9, 2)
    axes.plot([1e6 * speed * eta for eta in even], [1e9 * unit * style.closed_form(0.7) * eta for eta in even], "o",
              color="black", fillstyle="none", markersize=9, label=r"even $\eta$, closed form")
    axes.set(xlabel=r"drag speed [$\mu$m/s]", ylabel="mean friction force [nN]", xlim=(0, 1e6 * speed * 9),
             ylim=(0, None))
    top = axes.secondary_xaxis("top", functions=(lambda v: v * 1e-6 / speed, lambda eta: eta * speed * 1e6))
    top.set_xlabel(style.ETA_LABEL)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 1.0), framealpha=1.0, frameon=True, edgecolor="white")
    return figure


@table()
def mica_in_si(_):
    speed, unit = LATTICE / TAU, TIP_MASS * LATTICE / TAU ** 2
    rows = [("vertical stiffness", "k_v = m omega_v^2", TIP_MASS * OMEGA_V ** 2, "N/m"),
            ("horizontal stiffness", "k_h = m omega_h^2", TIP_MASS * OMEGA_H ** 2, "N/m"),
            ("period", "tau = 2 pi / omega_v", TAU, "s"),
            ("unit of speed, eta = 1", "a / tau", speed, "m/s"),
            ("unit of force", "m_tip a / tau^2", unit, "N"),
            ("unit of energy", "m_tip a^2 / tau^2", unit * LATTICE, "J"),
            ("unit of K_f", "m_tip / tau", TIP_MASS / TAU, "kg/s"),
            ("cutoff, v_c = 0.05", "0.05 a / tau", 0.05 * speed, "m/s"),
            ("K_f at even eta", "%.6f m_tip / tau" % style.closed_form(0.7), style.closed_form(0.7) * TIP_MASS / TAU,
             "kg/s"),
            ("friction force at eta = 2", "K_f v_0", 2 * style.closed_form(0.7) * unit, "N"),
            ("static load on a crest", "k_v H", TIP_MASS * OMEGA_V ** 2 * AMPLITUDE, "N"),
            ("thermal energy at 300 K", "kT = %.3f m_tip a^2 / tau^2" % (BOLTZMANN * 300 / (unit * LATTICE)),
             BOLTZMANN * 300, "J")]
    return ["quantity", "formula", "value", "unit"], [(a, b, "%.4g" % value, d) for a, b, value, d in rows]

"""docs/friction.md: the hammer's friction and orbits, its section in letters, and how far it is from the oscillator."""
import math

from commands import HAMMER_ETAS as ETAS
from registry import picture

from . import style

MODELS = {"oscillator": (style.BLUE, "o"), "hammer": (style.ORANGE, "s")}  # in every picture
LOOKS = dict(zip(ETAS, ((style.GREEN, "^"), (style.BLUE, "o"), (style.PINK, "s"))))
LETTERS = dict(zip("abcdefgh", (style.BLUE, style.AMBER, style.GREEN, style.PINK, "black", style.SKY)))


def orbit_of_one(eta, cells, gamma=0.7):
    """K_f of the hammer's orbit of one impact in so many cells."""
    e = (1.0 + gamma) / (1.0 - gamma)
    q = math.tan(math.pi * cells / eta) / (eta * e)
    return 2.0 * e * style.S ** 2 * eta / cells * q * q / (1.0 + q * q)


@picture("hammer_curve_oscillator", "hammer_curve_hammer")
def hammer_friction(tables):
    figure, axes = style.new(4.8)
    for model, (colour, marker) in MODELS.items():
        rows = tables.rows("hammer_curve_" + model)
        axes.semilogy([row["eta"] for row in rows], [max(row["k_f"], 1e-4) for row in rows], marker, color=colour,
                      markersize=4, label=model, markerfacecolor="white" if model == "hammer" else colour)
    for cells in range(1, 5):
        etas = [2 * cells - 0.7 + 0.01 * i for i in range(140)]
        axes.semilogy(etas, [orbit_of_one(eta, cells) for eta in etas], color="black", linewidth=1,
                      label="hammer, orbits of one impact: closed form" if cells == 1 else None)
    axes.set(xlabel=style.ETA_LABEL, ylabel=style.K_F_LABEL + r"; zero is drawn at $10^{-4}$", ylim=(7e-5, 20))
    style.legend_above(axes)
    return figure


def largest(rows, keys, value):
    """Of the rows that agree in the keys: the one whose value is largest in size."""
    worst = {}
    for row in rows:
        key = tuple(row[k] for k in keys)
        if key not in worst or abs(row[value]) > abs(worst[key][value]):
            worst[key] = row
    return [worst[key] for key in sorted(worst)]


@picture("hammer_error_eta")
def hammer_error(tables):
    rows = largest(tables.rows("hammer_error_eta"), ["eta"], "k_f_error")
    etas = [row["eta"] for row in rows]
    figure, axes = style.new(7.4, 3, 1, sharex=True)
    line = dict(linewidth=0.6, markersize=4)
    axes[0].semilogy(etas, [abs(row["k_f_error"]) for row in rows], "o-", color=style.BLUE, **line)
    axes[0].axhline(style.S ** 2, color="black", linewidth=0.9, linestyle=":",
                    label="closed form at even $\\eta$: $s^2$ = %.3f" % style.S ** 2)
    axes[0].set_ylabel("relative error of $K_f$")
    for key, colour, marker, fill, label in (
            ("tracking_error", style.GREEN, "^", {}, r"from one state on, over one $\tau$"),
            ("deflection_error", style.BLUE, "o", {}, "between the distributions"),
            ("deflection_noise", style.BLUE, "o", style.OPEN, "between two halves of one run: the noise")):
        axes[1].semilogy(etas, [max(1e-6, row[key] / row["deflection_rms"]) for row in rows], marker + "-", color=colour,
                         label=label, **line, **fill)
    axes[1].set_ylabel("difference of the vertical\ndeflection, over its rms")
    axes[2].semilogy(etas, [row["cost_ratio"] for row in rows], "o-", color=style.BLUE, **line)
    axes[2].axhline(1.0, color="black", linewidth=0.9, linestyle=":", label="the same time")
    axes[2].set(ylabel="processor time:\noscillator / hammer", xlabel=style.ETA_LABEL)
    for ax in axes:
        style.legend_above(ax)
    return figure


@picture("hammer_error_ratio")
def hammer_ratio(tables):
    rows = tables.rows("hammer_error_ratio")
    figure, axes = style.new(6.4, 2, 2, sharex=True)
    panels = ((axes[0][0], "relative error of the hammer's $K_f$", lambda row: abs(row["k_f_error"])),
              (axes[0][1], "largest lateral deflection [a]", lambda row: row["extension_max"]),
              (axes[1][0], r"rms of the lateral velocity [$v_0$]",
               lambda row: style.TWO_PI * row["frequency_ratio"] * row["extension_rms"] / row["eta"]),
              (axes[1][1], "processor time: oscillator / hammer", lambda row: row["cost_ratio"]))
    for ax, label, value in panels:
        for eta, (colour, marker) in LOOKS.items():
            mine = [row for row in rows if row["eta"] == eta]
            ax.loglog([row["frequency_ratio"] for row in mine], [value(row) for row in mine], marker, color=colour,
                      markersize=4, label=r"$\eta$ = %g" % eta)
        ax.set_ylabel(label)
    style.legend_above(axes[0][0])
    for ax in axes[1]:
        ax.set_xlabel(r"stiffness of the horizontal spring, $\omega_h/\omega_v$")
    return figure


@picture("hammer_section", "hammer_orbits")
def hammer_section(tables):
    points, orbits = tables.rows("hammer_section"), [row for row in tables.rows("hammer_orbits")
                                                     if row["approach"] < 0.1]
    figure, axes = style.new(4.8, 1, 2, sharey=True)
    for ax, suffix, title in ((axes[0], "", "impacts on the attractor, each with its letter"),
                              (axes[1], "_next", "the next impact of each")):
        for letter in sorted({row["letter"] for row in points}):
            mine = [row for row in points if row["letter"] == letter]
            ax.plot([row["phase" + suffix] for row in mine], [row["gap_rate" + suffix] for row in mine], ".",
                    color=LETTERS[letter], markersize=2, label=letter)
        ax.set_title(title, loc="left")
        ax.set_xlabel("surface phase of the impact [a]")
    axes[0].plot([row["phase"] for row in orbits], [row["gap_rate"] for row in orbits], "o", markerfacecolor="none",
                 color="black", markersize=6, linestyle="none")
    for i, row in enumerate(row for row in orbits if row["length"] <= 4):
        axes[0].annotate("orbit " + row["word"], (row["phase"], row["gap_rate"]), xytext=(0.6, 1.1 + 0.11 * i),
                         va="center", arrowprops={"arrowstyle": "-", "linewidth": 0.6, "shrinkB": 4})
    axes[0].set_ylabel(r"gap rate after the impact [a/$\tau$]")
    style.legend_above(axes[1], columns=4, markerscale=6)
    return figure


@picture("hammer_words", "hammer_cycles", "hammer_direct")
def hammer_cycles(tables):
    words, rows, direct = tables.rows("hammer_words"), tables.rows("hammer_cycles"), tables.rows("hammer_direct")[0]
    figure, axes = style.new(4.2, 1, 2)
    axes[0].plot([row["length"] for row in words], [row["entropy"] for row in words], "o-", color=style.BLUE,
                 label="entropy of a letter, given those before it")
    axes[0].axhline(words[0]["exponent"], color="black", linestyle=":", label="Lyapunov exponent of an impact")
    axes[0].set(ylabel="entropy of a letter [nat]", xlabel="letters in a word")
    for method, colour, marker, fill, label in (("zeta", style.BLUE, "o", {}, "zeta function"),
                                                ("determinant", style.GREEN, "s", style.OPEN, "determinant")):
        mine = [row for row in rows if row["method"] == method]
        axes[1].plot([row["order"] for row in mine], [row["k_f"] for row in mine], marker + "-", color=colour, label=label,
                     **fill)
    axes[1].axhline(direct["k_f"], color="black", linestyle=":", label="direct simulation")
    axes[1].set(xlabel="impacts in the longest orbit used", ylabel=style.K_F_LABEL)
    style.legend_above(axes[0], columns=1)
    style.legend_above(axes[1])
    return figure

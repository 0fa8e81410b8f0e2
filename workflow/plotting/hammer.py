"""docs/friction.md: the hammer's friction and orbits, its section in letters, and how far it is from the oscillator."""
import math

from commands import HAMMER_ETA as ETA, HAMMER_ETAS as ETAS
from registry import picture

from . import style

COLOURS = dict(zip(ETAS, (style.GREEN, style.BLUE, style.ORANGE)))
LETTERS = dict(zip("abcdefgh", (style.BLUE, style.SKY, style.ORANGE, style.YELLOW, style.GREEN, style.PINK)))


def orbit_of_one(eta, cells, gamma=0.7):
    """K_f of the hammer's orbit of one impact in so many cells."""
    e = (1.0 + gamma) / (1.0 - gamma)
    q = math.tan(math.pi * cells / eta) / (eta * e)
    return 2.0 * e * style.S ** 2 * eta / cells * q * q / (1.0 + q * q)


@picture("hammer_curve_oscillator", "hammer_curve_hammer")
def hammer_friction(tables):
    figure, axes = style.new(9.0, 5.0)
    for model, colour in (("oscillator", style.ORANGE), ("hammer", style.BLUE)):
        rows = tables.rows("hammer_curve_" + model)
        axes.semilogy([row["eta"] for row in rows], [max(row["k_f"], 1e-4) for row in rows], ".", color=colour,
                      markersize=5, label=model)
    for cells in range(1, 5):
        etas = [2 * cells - 0.7 + 0.01 * i for i in range(140)]
        axes.semilogy(etas, [orbit_of_one(eta, cells) for eta in etas], color=style.GREY, linewidth=1,
                      label="hammer, orbits of one impact: closed form" if cells == 1 else None)
    axes.set_xlabel(style.ETA_LABEL)
    axes.set_ylabel(style.K_F_LABEL + " (0 drawn at 1e-4)")
    style.legend_above(axes)
    figure.suptitle(r"Friction of the hammer and of the oscillator, $\gamma$ = 0.7, $v_c$ = 0.05 a/$\tau$")
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
    figure, axes = style.new(9.0, 8.0, 3, 1, sharex=True)
    axes[0].semilogy(etas, [abs(row["k_f_error"]) for row in rows], ".-", color=style.BLUE, linewidth=0.6)
    axes[0].axhline(style.S ** 2, color=style.GREY, linewidth=0.8)
    axes[0].text(9.05, style.S ** 2, " s²", color=style.GREY, va="center")
    axes[0].set_ylabel(r"error of $K_f$, relative")
    for key, colour, label in (("tracking_error", style.ORANGE, "after one state: rms over one tau"),
                               ("deflection_error", style.BLUE, "of the distribution"),
                               ("deflection_noise", style.SKY, "of two halves of one run")):
        axes[1].semilogy(etas, [max(1e-6, row[key] / row["deflection_rms"]) for row in rows], ".-", color=colour,
                         linewidth=0.6, label=label)
    axes[1].set_ylabel("error of the deflection\nover its rms")
    style.legend_above(axes[1])
    axes[2].semilogy(etas, [row["cost_ratio"] for row in rows], ".-", color=style.GREEN, linewidth=0.6)
    axes[2].axhline(1.0, color=style.GREY, linewidth=0.8)
    axes[2].set_ylabel("time of the oscillator\nover the hammer's")
    axes[2].set_xlabel(style.ETA_LABEL)
    axes[0].set_title(r"The hammer against the oscillator: $\omega_h/\omega_v$ = 6.25, $\gamma$ = 0.7, "
                      r"$v_c$ = 0.05 $\eta$")
    return figure


@picture("hammer_error_ratio")
def hammer_ratio(tables):
    rows = tables.rows("hammer_error_ratio")
    figure, axes = style.new(10.0, 7.0, 2, 2, sharex=True)
    panels = ((axes[0][0], r"error of $K_f$, relative", lambda row: abs(row["k_f_error"])),
              (axes[0][1], r"largest stretch $|x - x_c|$ / a", lambda row: row["stretch_max"]),
              (axes[1][0], r"rms of $\dot{x} - v_0$ over $v_0$",
               lambda row: style.TWO_PI * row["frequency_ratio"] * row["stretch_rms"] / row["eta"]),
              (axes[1][1], "oscillator's time over hammer's", lambda row: row["cost_ratio"]))
    for ax, label, value in panels:
        for eta in ETAS:
            mine = [row for row in rows if row["eta"] == eta]
            ax.loglog([row["frequency_ratio"] for row in mine], [value(row) for row in mine], ".", color=COLOURS[eta],
                      label=r"$\eta$ = %g" % eta)
        ax.set_ylabel(label)
    style.legend_above(axes[0][0])
    for ax in axes[1]:
        ax.set_xlabel(r"$\omega_h/\omega_v$")
    figure.suptitle("A stiffer horizontal spring stretches less and less, but moves as fast: "
                    "its limit is not the hammer")
    return figure


@picture("hammer_section", "hammer_orbits")
def hammer_section(tables):
    points, orbits = tables.rows("hammer_section"), [row for row in tables.rows("hammer_orbits")
                                                     if row["approach"] < 0.1]
    figure, axes = style.new(10.0, 4.8, 1, 2, sharey=True)
    for ax, suffix, title in ((axes[0], "", "the attractor, cut into letters"),
                              (axes[1], "_next", "where the map takes each letter")):
        for letter in sorted({row["letter"] for row in points}):
            mine = [row for row in points if row["letter"] == letter]
            ax.plot([row["phase" + suffix] for row in mine], [row["gap_rate" + suffix] for row in mine], ".",
                    color=LETTERS[letter], markersize=1.5, label=letter)
        ax.set_title(title)
        ax.set_xlabel("surface phase / a")
    for row in orbits:
        axes[0].plot(row["phase"], row["gap_rate"], "o", markerfacecolor="none", color="black", markersize=5)
    for i, row in enumerate(row for row in orbits if row["length"] <= 4):
        axes[0].annotate(row["word"], (row["phase"], row["gap_rate"]), xytext=(0.58, 1.1 + 0.1 * i),
                         arrowprops={"arrowstyle": "-", "linewidth": 0.5})
    axes[0].set_ylabel(r"gap rate after the impact / (a/$\tau$)")
    axes[1].legend(markerscale=6)
    figure.suptitle(r"The hammer's section, $\eta$ = %g, $\gamma$ = 0.7; "
                    "circles: the first point of each orbit up to 8 impacts"
                    % ETA)
    return figure


@picture("hammer_words", "hammer_cycles", "hammer_direct")
def hammer_cycles(tables):
    words, rows, direct = tables.rows("hammer_words"), tables.rows("hammer_cycles"), tables.rows("hammer_direct")[0]
    figure, axes = style.new(10.0, 4.5, 1, 2)
    axes[0].plot([row["length"] for row in words], [row["entropy"] for row in words], "o-", color=style.BLUE,
                 label="of a letter, given those before it")
    axes[0].axhline(words[0]["exponent"], color=style.GREY, label="Lyapunov exponent of an impact")
    axes[0].set_ylabel("entropy / nat")
    axes[0].set_xlabel("letters of a word")
    axes[0].legend()
    for method, colour in (("zeta", style.BLUE), ("determinant", style.ORANGE)):
        mine = [row for row in rows if row["method"] == method]
        axes[1].plot([row["order"] for row in mine], [row["k_f"] for row in mine], "o-", color=colour, label=method)
    axes[1].axhline(direct["k_f"], color=style.GREY, label="direct, %.5f(%.0f)"
                    % (direct["k_f"], 1e5 * direct["k_f_std_error"]))
    axes[1].set_xlabel("longest orbit or product of orbits / impacts")
    axes[1].set_ylabel(style.K_F_LABEL)
    axes[1].legend()
    figure.suptitle(r"Words and friction from orbits: hammer, $\eta$ = %g, $\gamma$ = 0.7" % ETA)
    return figure

"""The scaling predictions of section VI."""
from registry import picture

from . import style


@picture("scaling_eta", "scaling_gamma")
def fig9_scaling(tables):
    rows, gammas = tables.rows("scaling_eta"), tables.rows("scaling_gamma")
    figure, axes = style.new(4.6, 1, 2)
    looks = ((style.BLUE, "o", {}), (style.ORANGE, "s", style.OPEN), (style.GREEN, "^", {}), ("black", "x", {}))
    for shift, (colour, marker, fill) in zip((0, 2, 4, 6), looks):
        some = [row for row in rows if shift + 1 <= row["eta"] <= shift + 3]
        axes[0].plot([row["eta"] - shift for row in some], [row["mean_flight_time"] for row in some], marker,
                     color=colour, markersize=3.5, label=r"$k$ = %d" % shift, **fill)
    axes[0].set_xlabel(r"drag speed less an even number, $\eta - k$ [$a/\tau$]")
    axes[0].set_ylabel(r"mean time between impacts [$\tau$]")
    style.legend_above(axes[0], columns=4, handletextpad=0.1)
    points = [row for row in gammas if not row["event"] and row["k_f"] > 1.0]
    gamma = [row["value"] for row in points]
    axes[1].plot(gamma, [style.closed_form(value) for value in gamma], color="black", label="closed form")
    axes[1].plot(gamma[::10], [row["k_f"] for row in points][::10], "o", color=style.BLUE, markersize=5,
                 label=r"computed orbit, $\eta$ = 4", **style.OPEN)
    natural = [0.5 * (1.0 - value ** 2) * style.AMPLITUDE ** 2 for value in gamma]
    axes[1].plot(gamma, [2571 * k for k in natural], color=style.ORANGE, linestyle="--", label="2571 times Eq. 21")
    axes[1].set_xlabel(r"restitution $\gamma$")
    axes[1].set_ylabel(style.K_F_LABEL)
    axes[1].set_ylim(bottom=0)
    style.legend_above(axes[1])
    return figure

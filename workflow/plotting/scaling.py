"""The scaling predictions of section VI."""
from registry import picture

from . import style


@picture("scaling_eta", "scaling_gamma")
def fig9_scaling(tables):
    rows, gammas = tables.rows("scaling_eta"), tables.rows("scaling_gamma")
    figure, axes = style.new(10.0, 4.5, 1, 2)
    for shift, colour in zip((0, 2, 4, 6), (style.BLUE, style.ORANGE, style.GREEN, style.PINK)):
        some = [row for row in rows if shift + 1 <= row["eta"] <= shift + 3]
        axes[0].plot([row["eta"] - shift for row in some], [row["mean_flight_time"] for row in some],
                     color=colour, linewidth=1,
                     label=r"$\eta$ = %d to %d" % (shift + 1, shift + 3))
    axes[0].set_xlabel(r"$\eta$ less 0, 2, 4, 6")
    axes[0].set_ylabel(r"mean time between impacts / $\tau$")
    axes[0].legend(fontsize=9)
    points = [row for row in gammas if not row["event"] and row["k_f"] > 1.0]
    axes[1].plot([row["value"] for row in points], [row["k_f"] for row in points], "o", color=style.BLUE, markersize=3,
                 label=r"the orbit at $\eta$ = 4")
    axes[1].plot([row["value"] for row in points], [style.closed_form(row["value"]) for row in points],
                 color=style.ORANGE,
                 label="closed form")
    natural = [0.5 * (1.0 - row["value"] ** 2) * style.AMPLITUDE ** 2 for row in points]
    axes[1].plot([row["value"] for row in points], [2571 * k for k in natural], color=style.GREY, linestyle="--",
                 label=r"2571 $K_{f,natural}$ (Eq. 21)")
    axes[1].set_xlabel(r"restitution $\gamma$")
    axes[1].set_ylabel(style.K_F_LABEL)
    axes[1].legend(fontsize=9)
    figure.suptitle("Scaling")
    return figure

"""Friction against load at fixed drag velocity."""
from commands import LOAD_ETAS
from registry import picture, table

from . import style
from .model import LATTICE, OMEGA_V, TAU, TIP_MASS

K_V = TIP_MASS * OMEGA_V ** 2  # [N/m]
NEWTON_V = K_V * LATTICE  # one a of the spring is so much force
CASES = (("no bath", style.BLUE, "o", "cold"), ("300 K, Q = 100", style.ORANGE, "s", "warm"))
READ = tuple("load_%g_%s" % (eta, end) for eta in LOAD_ETAS for end in ("cold", "warm"))


def newtons(k_f, eta):
    """Mean lateral force of K_f [m_tip/tau] at eta."""
    return k_f * eta * TIP_MASS * LATTICE / TAU ** 2


def liftoff(eta):
    """The load above which the tip follows the surface over its crests, without friction [nN]."""
    return 1e9 * NEWTON_V * style.AMPLITUDE * (eta ** 2 - 1)


@table(*READ)
def load(tables):
    return (("eta", "bath", "rest_height", "k_f_work", "k_f_work_std_error"),
            [(eta, name, row["rest_height"], row["k_f_work"], row["k_f_work_std_error"]) for eta in LOAD_ETAS
             for name, _, _, end in CASES for row in tables.rows("load_%g_%s" % (eta, end))])


@picture("load", name="load")
def draw_load(tables):
    """A dot for each height of the holder: between two of them the attractor may change."""
    rows = tables.rows("load")
    figure, axes = style.new(9.6, len(LOAD_ETAS), 1, sharex=True)
    for ax, eta in zip(axes, LOAD_ETAS):
        for name, colour, marker, _ in CASES:
            some = [row for row in rows if row["eta"] == eta and row["bath"] == name]
            look = dict(markersize=3.2) if marker == "o" else dict(markersize=3.8, markerfacecolor="white",
                                                                    markeredgewidth=0.9)
            ax.errorbar([-1e9 * NEWTON_V * row["rest_height"] for row in some],
                        [1e12 * newtons(row["k_f_work"], eta) for row in some],
                        [1.96e12 * newtons(row["k_f_work_std_error"], eta) for row in some], fmt=marker, color=colour,
                        elinewidth=0.7, label=name, **look)
        if eta > 1:
            ax.axvline(liftoff(eta), color="black", linestyle=":", linewidth=1.2, label=r"$k_v H (\eta^2 - 1)$")
        ax.set_ylabel("mean lateral force [pN]")
        ax.set_title(r"$\eta$ = %g (%.3g $\mu$m/s)" % (eta, eta * 1e6 * LATTICE / TAU), loc="left")
    handles, labels = axes[1].get_legend_handles_labels()
    axes[0].legend(handles, labels, loc="upper right")
    height = axes[-1].secondary_xaxis(-0.32, functions=(lambda F: -F / K_V, lambda y: -K_V * y))
    height.set_xlabel("height of the holder $y_0$ [nm]")
    axes[-1].set_xlabel(r"load $-k_v y_0$ [nN];  left of 0 the holder is above mid-surface")
    return figure

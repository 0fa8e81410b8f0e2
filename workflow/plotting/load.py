"""Friction against load at fixed drag velocity."""
from commands import LOAD_ETAS
from registry import picture, table

from . import style

# one a of the spring is so much force: k_v a and k_h a, k = m omega^2 (mica)
NEWTON_V = 4.08e-10 * 4e4 ** 2 * 5.2e-10
TAU = style.TWO_PI / 4e4
CASES = (("no bath", style.BLUE, "-", "cold"), ("300 K, Q = 100", style.ORANGE, "--", "warm"))
READ = tuple("load_%g_%s" % (eta, end) for eta in LOAD_ETAS for end in ("cold", "warm"))


def newtons(k_f, eta):
    """Mean lateral force of K_f [m_tip/tau] at eta."""
    return k_f * eta * 4.08e-10 * 5.2e-10 / TAU ** 2


def liftoff(eta):
    """The load above which the tip follows the surface over its crests, without friction [nN]."""
    return 1e9 * NEWTON_V * style.AMPLITUDE * (eta ** 2 - 1)


@table(*READ)
def load(tables):
    return (("eta", "bath", "rest_height", "k_f_work", "k_f_work_std_error"),
            [(eta, name, row["rest_height"], row["k_f_work"], row["k_f_work_std_error"]) for eta in LOAD_ETAS
             for name, _, _, end in CASES for row in tables.rows("load_%g_%s" % (eta, end))])


@picture(*READ, name="load")
def draw_load(tables):
    figure, axes = style.new(9.0, 9.0, len(LOAD_ETAS), 1, sharex=True)
    for ax, eta in zip(axes, LOAD_ETAS):
        for name, colour, line, end in CASES:
            rows = tables.rows("load_%g_%s" % (eta, end))
            force = [1e9 * newtons(row["k_f_work"], eta) for row in rows]
            error = [1.96e9 * newtons(row["k_f_work_std_error"], eta) for row in rows]
            load_n = [-1e9 * NEWTON_V * row["rest_height"] for row in rows]
            ax.plot(load_n, force, color=colour, linestyle=line, linewidth=1.2, label=name)
            ax.fill_between(load_n, [f - e for f, e in zip(force, error)], [f + e for f, e in zip(force, error)],
                            color=colour, alpha=0.3, linewidth=0)
        if eta > 1:
            ax.axvline(liftoff(eta), color="black", linestyle=":", linewidth=1.2, label=r"$k_v H (\eta^2 - 1)$")
        ax.set_ylabel(r"$\eta$ = %g:  lateral force / nN" % eta)
        ax.grid(color="#dddddd", linewidth=0.6)
    axes[1].legend(loc="upper right", frameon=False)
    axes[-1].set_xlabel(r"load $-k_v y_0$ / nN")
    return figure

"""FIG. 1: K_f against drag velocity, and what it depends on besides."""
from commands import WINDOWS
from registry import picture, table

from . import style


SWEPT = ("friction_curve_up", "friction_curve_down")


def swept(tables, direction):
    """K_f against eta, each point begun where the one before it ended: "up" or "down"."""
    return sorted(tables.rows("friction_curve_" + direction), key=lambda row: row["eta"])


@picture(*SWEPT)
def fig1_friction(tables):
    figure, (linear, logarithmic) = style.new(7.4, 2, 1, sharex=True, constrained_layout=False)
    figure.subplots_adjust(left=0.075, right=0.905, top=0.955, bottom=0.07, hspace=0.06)
    peak = style.closed_form(0.7)
    for axes in (linear, logarithmic):
        for direction, line in style.SWEEPS.items():
            rows = swept(tables, direction)
            eta = [row["eta"] for row in rows]
            K, error = [[row[name] for row in rows] for name in ("k_f_work", "k_f_work_std_error")]
            axes.plot(eta, K, **line)
            axes.fill_between(eta, *[[max(1e-12, k + sign * 1.96 * e) for k, e in zip(K, error)] for sign in (-1, 1)],
                              color=line["color"], alpha=0.3, linewidth=0)
        axes.plot([2, 4, 6, 8], [peak] * 4, "o", color="black", fillstyle="none", markersize=9,
                  label=r"closed form at even $\eta$: %.4f" % peak)
        axes.set_ylabel(style.K_F_LABEL)
        right = axes.secondary_yaxis("right", functions=(lambda k: k * style.PAPER * 1e4,
                                                         lambda k: k / style.PAPER / 1e4))
        right.set_ylabel(r"$K_f$ [$10^{-4}$ of the paper's unit]")
    linear.set(xlim=(0, 9), ylim=(0, 1.08 * peak))
    logarithmic.set(yscale="log", ylim=(1e-4, 10), xlabel=style.ETA_LABEL)
    style.legend_above(linear)
    return figure


# relative standard error of K_f: beyond it a transient outlasts the measurement (eta = 25/12, a resonance of omega_h)
MOST_ERROR = 0.2


def draw_attractors(axes, rows):
    """Each attractor a sign, the larger the more starts it draws."""
    kinds = (("period-1", "period 1", style.BLUE, "o", True), ("period-", "longer periods", style.BLUE, "o", False),
             ("quasi-periodic", "quasi-periodic", style.GREEN, "^", True), ("chaotic", "chaotic", style.ORANGE, "s", False),
             ("contact", "contact", style.PINK, "D", True))
    left = [row for row in rows if row["k_f_std_error"] <= MOST_ERROR * row["k_f"]]
    for name, label, colour, marker, filled in kinds:
        some = [r for r in left if r["attractor"] == name or (name == "period-" and r["attractor"].startswith(name))]
        left = [r for r in left if r not in some]
        if some:
            axes.scatter([r["eta"] for r in some], [r["k_f"] for r in some], s=[4 + 26 * r["basin"] for r in some],
                         marker=marker, facecolor=colour if filled else "none", edgecolor=colour, linewidths=0.7,
                         label=label)


COEXISTING = (2, 2.5, 3.75, 6.5)


@table(*("coexisting_%g" % eta for eta in COEXISTING))
def friction_attractors(tables):
    """Of docs/friction.md: what coexists at four drag speeds."""
    rows = []
    for eta in COEXISTING:
        found = tables.rows("coexisting_%g" % eta)
        rows += [("%g" % eta, row["attractor"], "%.6g +- %.1g" % (row["k_f"], row["k_f_std_error"]),
                  "%.2f +- %.2f" % (row["basin"], row["basin_std_error"]))
                 for row in sorted(found, key=lambda row: -row["basin"])]
    return ["eta", "attractor", "K_f [m_tip/tau]", "share of 100 random starts"], rows


@picture(*(name % low for low, _ in WINDOWS for name in ("coexistence_%g", "sweep_up_%g", "sweep_down_%g")))
def fig1_coexistence(tables):
    figure, axes = style.new(4.6, 1, 3)
    for ax, (low, _) in zip(axes, WINDOWS):
        draw_attractors(ax, tables.rows("coexistence_%g" % low))
        for direction, line in (("up", "-"), ("down", ":")):
            rows = tables.rows("sweep_%s_%g" % (direction, low))
            ax.plot([row["eta"] for row in rows], [row["k_f"] for row in rows], color="black", linestyle=line,
                    linewidth=0.9, label=r"one tip, $\eta$ %s slowly" % ("rising" if direction == "up" else "falling"))
        ax.set_xlabel(style.ETA_LABEL)
    axes[0].set_ylabel(style.K_F_LABEL)
    entries = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels())}
    style.legend_of_all(figure, entries, 7, columnspacing=1.2, handletextpad=0.4)
    return figure


@picture("scaling_eta", "scaling_gamma")
def fig9_scaling(tables):
    """The scaling predictions of section VI."""
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
    axes[1].set(xlabel=r"restitution $\gamma$", ylabel=style.K_F_LABEL, ylim=(0, None))
    style.legend_above(axes[1])
    return figure

"""FIG. 1: K_f against drag velocity, and what it depends on besides."""
from . import style


def sweep(tables, name, eta, step, *arguments):
    step = step * 10 if tables.quick else step
    return tables.make(name, "friction_curve", "--gamma", 0.7, "--cutoff", 0.05, "--eta", "%s:%g" % (eta, step),
                       *arguments)


def friction_curve(tables):
    rows = sweep(tables, "friction_curve", "0.02:9", 0.01, "--duration", 10000)
    figure, axes = style.new(9.0, 5.0)
    eta = [row["eta"] for row in rows]
    axes.plot(eta, [row["k_f"] * style.PAPER for row in rows], color=style.BLUE, linewidth=1.0,
              label="direct simulation")
    axes.fill_between(eta, *[[(row["k_f"] + sign * 1.96 * row["k_f_std_error"]) * style.PAPER for row in rows]
                             for sign in (-1, 1)], color=style.SKY, alpha=0.6, linewidth=0, label="95 % interval")
    peak = style.closed_form(0.7)
    axes.axhline(peak * style.PAPER, color=style.ORANGE, linestyle="--", linewidth=1.2,
                 label=r"closed form at even $\eta$: %.4f m/$\tau$" % peak)
    axes.set_xlabel(style.ETA_LABEL)
    axes.set_ylabel(r"$K_f$ in the paper's units")
    axes.set_xlim(0, 9)
    axes.set_ylim(0, 1.12e-4)
    right = axes.secondary_yaxis("right", functions=(lambda y: y / style.PAPER, lambda y: y * style.PAPER))
    right.set_ylabel(style.K_F_LABEL)
    axes.legend(loc="upper left", fontsize=9)
    axes.set_title(r"FIG. 1: friction coefficient, $\gamma$ = 0.7, $v_c$ = 0.05 a/$\tau$")
    return figure


def draw_attractors(axes, rows):
    """Each attractor a dot, the larger the more starts it draws."""
    kinds = (("period-1", "period 1", style.BLUE), ("period-", "longer periods", style.SKY),
             ("quasi-periodic", "quasi-periodic", style.GREEN), ("chaotic", "chaotic", style.ORANGE),
             ("contact", "contact", style.YELLOW))
    left = list(rows)
    for name, label, colour in kinds:
        some = [r for r in left if r["attractor"] == name or (name == "period-" and r["attractor"].startswith(name))]
        left = [r for r in left if r not in some]
        axes.scatter([r["eta"] for r in some], [r["k_f"] for r in some], s=[3 + 25 * r["basin"] for r in some],
                     color=colour,
                     label=label, linewidths=0)


def coexistence(tables):
    windows = [(1.9, 2.15), (3.6, 3.9), (6.2, 6.7)]
    figure, axes = style.new(11.0, 4.5, 1, 3)
    for ax, (low, high) in zip(axes, windows):
        step = (high - low) / (10 if tables.quick else 100)
        draw_attractors(ax, tables.make("coexistence_%g" % low, "attractors", "--gamma", 0.7, "--cutoff", 0.05, "--eta",
                                        "%g:%g:%g" % (low, high, step), "--starts", 10 if tables.quick else 60,
                                        "--friction-duration", 300))
        for direction, line in (("up", "-"), ("down", ":")):
            rows = sweep(tables, "sweep_%s_%g" % (direction, low), "%g:%g" % (low, high), 0.0025, "--sweep", direction,
                         "--duration", 3000)
            ax.plot([row["eta"] for row in rows], [row["k_f"] for row in rows], color="black", linestyle=line,
                    linewidth=0.8,
                    label="one tip, drag velocity %s" % ("raised" if direction == "up" else "lowered"))
        ax.set_xlabel(style.ETA_LABEL)
    axes[0].set_ylabel(style.K_F_LABEL)
    axes[1].legend(fontsize=8)
    figure.suptitle(r"Where attractors coexist friction depends on history "
                    r"($\gamma$ = 0.7; the area of a dot: its basin)")
    return figure

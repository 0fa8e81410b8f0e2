"""docs/levers.md: how many times real time a lever makes, and friction against load."""
from commands import CRYSTALS, LEVER_SPEED, LEVERS, values
from matplotlib.patches import Patch, Rectangle

from registry import picture, table

from . import style

NAMES = {"paper": "the paper's", "ppp_cont": "PPP-CONT", "csc37_b": "CSC37-B", "soft": "soft",
         "force_modulation": "force modulation", "laterally_soft": "laterally soft"}
BATHS = (("times_real_time", "no bath"), ("heated_times_real_time", "300 K"))
SURFACES = {"mica": "mica", "nacl": "NaCl(001)", "hopg": "HOPG"}
STEPS = ((0.0, style.ORANGE, "white", "below 1: falls behind"), (1.0, style.YELLOW, "black", "1 to 3"),
         (3.0, style.SKY, "black", "3 to 10"), (10.0, style.BLUE, "white", "above 10"))
LOOKS = dict(zip(LEVERS, ((style.BLUE, "o", {}), (style.ORANGE, "s", style.OPEN), (style.GREEN, "^", {}))))


def step_of(times):
    return [step for step in STEPS if times >= step[0]][-1]


def draw_lever(axes, rows, bath):
    loads, speeds = (sorted({row[name] for row in rows}) for name in ("load_nn", "speed_um_per_s"))
    for i, load in enumerate(loads):
        for j, speed in enumerate(speeds):
            least = min(row[bath] for row in rows
                        if row["load_nn"] == load and row["speed_um_per_s"] == speed)
            _, colour, ink, _ = step_of(least)
            axes.add_patch(Rectangle((j, i), 0.96, 0.95, facecolor=colour, linewidth=0))
            axes.text(j + 0.48, i + 0.47, "%.2g" % least if least < 100 else "%.0f" % least, ha="center", va="center",
                      color=ink, fontsize=style.SMALL)
    axes.set(xlim=(0, len(speeds)), ylim=(0, len(loads)))
    axes.set_xticks([j + 0.48 for j in range(len(speeds))])
    axes.set_xticklabels(["%g" % speed for speed in speeds])
    axes.set_yticks([i + 0.47 for i in range(len(loads))])
    axes.set_yticklabels(["%g" % load for load in loads])
    axes.tick_params(length=0)
    axes.grid(False)
    axes.set_frame_on(False)


@picture("levers")
def lever_map(tables):
    """Of the three crystals the slowest."""
    rows = tables.rows("levers")
    figure, axes = style.new(9.8, 4, 3, sharex=True, sharey=True)
    panels = [(bath, text, lever) for bath, text in BATHS for lever in NAMES]
    for ax, (bath, text, lever) in zip(axes.flat, panels):
        mine = [row for row in rows if row["lever"] == lever]
        draw_lever(ax, mine, bath)
        ax.set_title(r"%s, $\tau$ = %.0f $\mu$s, %s" % (NAMES[lever], mine[0]["tau_us"], text), loc="left",
                     fontsize=style.SMALL)
    for ax in axes[-1]:
        ax.set_xlabel(r"drag speed [$\mu$m/s]")
    for ax in axes[:, 0]:
        ax.set_ylabel("load [nN]")
    style.legend_of_all(figure, {text: Patch(facecolor=colour) for _, colour, _, text in STEPS}, 4)
    return figure


READ = tuple("lever_%s_%s" % (lever, crystal) for lever in LEVERS for crystal in CRYSTALS)


@table(*READ)
def lever_friction(tables):
    """In SI: rest height and K_f of each curve times the units of its lever."""
    rows = []
    for lever in LEVERS:
        for crystal in CRYSTALS:
            spring, surface = values("config/levers/%s.yaml" % lever), values("config/surfaces/%s.yaml" % crystal)
            stiffness, a = spring["spring_constant_n_per_m"], surface["lattice_spacing_m"]
            # K_f v0 = k_f (m_tip/tau) v0, with m_tip = k / (2 pi f0)^2 and tau = 1/f0
            newtons = stiffness / (style.TWO_PI ** 2 * spring["resonance_hz"]) * LEVER_SPEED
            curve = tables.rows("lever_%s_%s" % (lever, crystal))
            rows += [(lever, crystal, 0.0 - 1e9 * stiffness * a * row["rest_height"], 1e12 * newtons * row["k_f_work"],
                      1e12 * newtons * row["k_f_work_std_error"]) for row in curve]
    return ("lever", "crystal", "load_nn", "force_pn", "force_std_error_pn"), rows


@picture("lever_friction", name="lever_friction")
def draw_lever_friction(tables):
    rows = tables.rows("lever_friction")
    figure, axes = style.new(4.2, 1, 3)
    for ax, crystal in zip(axes, CRYSTALS):
        for lever, (colour, marker, fill) in LOOKS.items():
            mine = [row for row in rows if row["lever"] == lever and row["crystal"] == crystal]
            ax.errorbar([1e3 * row["load_nn"] for row in mine], [row["force_pn"] for row in mine],
                        [1.96 * row["force_std_error_pn"] for row in mine], color=colour, marker=marker, markersize=4,
                        linewidth=0.9, label=NAMES[lever], **fill)
        ax.axhline(0.0, color="black", linewidth=0.6)
        ax.set_title(SURFACES[crystal], loc="left")
        ax.set_xlabel("load [pN]")
    axes[0].set_ylabel("mean lateral force [pN]")
    handles, labels = axes[0].get_legend_handles_labels()
    style.legend_of_all(figure, dict(zip(labels, handles)), 3)
    return figure

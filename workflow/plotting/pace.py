"""Which method can run an emulator: processor time per second of model time against the error of K_f. Left of the line
at 1 a method keeps up with the tip.
"""
import math

from registry import picture

from . import style
from .methods import METHODS, method_style

# eta = 3.4 is left out: nearly all methods agree there within the spread of chaotic runs (docs/accuracy.md)
SCENES = [("kf_2", r"$\eta$ = 2: against the closed form"),
          ("kf_3", r"$\eta$ = 3, $v_c$ = 0.01 $\eta$: 600 bounces in a $\tau$")]
LEAST, MOST = 1e-15, 1e2  # errors outside are drawn at the edge


def draw_scene(axes, rows, scene, title):
    chosen = [row for row in rows if row["scene"] == scene]
    for name in [name for name in METHODS if name in {row["method"] for row in chosen}]:
        label, colour, marker = method_style(name)
        data = [(float(r["seconds_per_second"]), float(r["k_f_error"])) for r in chosen if r["method"] == name]
        if name == "exact" and scene == "kf_3":  # every bounce by itself is the reference
            data = [point for point in data if point[1] > 0.0]
        data = [(x, min(MOST, max(LEAST, y)) if math.isfinite(y) else MOST) for x, y in data]
        axes.plot(*zip(*data), color=colour, marker=marker, markersize=13 if name == "exact" else 6, linewidth=1.1,
                  linestyle="--" if name.endswith("_minima") else "-",
                  label=label.replace("\n", " "))
    axes.axvline(1.0, color="#222222", linewidth=1.3)
    axes.text(0.85, 2e-13, "real time", rotation=90, va="bottom", ha="right")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LEAST, MOST * 3)
    axes.set_title(title)
    axes.set_xlabel("processor seconds for a second of model time")


@picture("pace", name="pace")
def draw(tables):
    rows = tables.strings("pace")
    figure, panels = style.new(5.6, 1, 2, sharey=True, constrained_layout=False)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.94, bottom=0.31, wspace=0.06)
    for axes, (scene, title) in zip(panels, SCENES):
        draw_scene(axes, rows, scene, title)
    panels[0].set_ylabel("relative error of $K_f$ (at the top: no result)")
    panels[0].annotate("better", (4.5e-3, 1e-9), xytext=(1.6e-2, 1e-7), color=style.GREY,
                       arrowprops=dict(arrowstyle="-|>", color=style.GREY))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="lower center", ncol=4)
    return figure

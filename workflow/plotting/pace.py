"""Which method can run an emulator: processor time per second of model time against the error of K_f. Left of the line
at 1 a method keeps up with the tip.
"""
import math

from registry import picture

from . import style
from .methods import METHODS, method_style

SCENES = [("kf_2", "η = 2: closed form"), ("kf_3.4", "η = 3.4: chaotic"), ("kf_3", "η = 3: splash")]
LEAST, MOST = 1e-16, 1e2  # errors outside are drawn at the edge


def draw_scene(axes, rows, scene, title):
    chosen = [row for row in rows if row["scene"] == scene]
    for name in [name for name in METHODS if name in {row["method"] for row in chosen}]:
        label, colour, marker = method_style(name)
        data = [(float(r["seconds_per_second"]), float(r["k_f_error"])) for r in chosen if r["method"] == name]
        data = [(x, min(MOST, max(LEAST, y)) if math.isfinite(y) else MOST) for x, y in data]
        axes.plot(*zip(*data), color=colour, marker=marker, markersize=14 if name == "exact" else 7, linewidth=1.2,
                  linestyle="--" if name.endswith("_minima") or name in ("cvode_bdf", "certified_plain") else "-",
                  label="ours" if name == "exact" else label.replace("\n", " "))
    chance = max(float(row["chance"]) for row in chosen) if chosen else 0.0
    if chance > 0.0:
        axes.axhspan(LEAST, 2.0 * chance, color="#e6e6e6", zorder=0)
        axes.text(0.02, 0.02, "shaded: within chance", transform=axes.transAxes, fontsize=11)
    axes.axvline(1.0, color="#222222", linewidth=1.5)
    axes.text(0.85, 1e-14, "real time", rotation=90, va="bottom", ha="right", fontsize=11)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LEAST / 2, MOST * 2)
    axes.set_title(title, fontsize=13)
    axes.set_xlabel("processor s per s of model time")
    axes.grid(which="major", color="#dddddd", linewidth=0.8)
    axes.set_axisbelow(True)


@picture("pace", name="pace")
def draw(tables):
    rows = tables.strings("pace")
    figure, panels = style.new(12.6, 6.4, 1, 3, sharey=True, constrained_layout=False)
    figure.subplots_adjust(left=0.065, right=0.985, top=0.94, bottom=0.28, wspace=0.06)
    for axes, (scene, title) in zip(panels, SCENES):
        draw_scene(axes, rows, scene, title)
    panels[0].set_ylabel("relative error of K_f (top: no result)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="lower center", ncol=5, fontsize=11, frameon=False)
    return figure

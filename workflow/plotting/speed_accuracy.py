"""Speed against accuracy: time per impact against the error of impact time and state.

A point for each setting of a method, a line for each method. Dashed lines: with the gap rate as a second event
(minima). An open point has missed impacts, or found some that are none.
"""
import math

from registry import picture

from . import style
from .methods import METHODS, method_style



def points(rows, method, scene, error):
    chosen = [row for row in rows if row["method"] == method and row["scene"] == scene]
    values = [(float(r["ns_per_impact"]), float(r[error]), int(r["missed"]) + int(r["phantom"])) for r in chosen]
    return [v for v in values if math.isfinite(v[1]) and v[1] > 0]


def draw_method(axes, name, data):
    label, colour, marker = method_style(name)
    ours = name == "exact"
    dashed = name in ("cvode_bdf", "certified_plain") or name.endswith("_minima")
    axes.plot([d[0] for d in data], [d[1] for d in data], color=colour, linewidth=1.6, zorder=2,
              linestyle="--" if dashed else "-",
              marker=marker, markersize=24 if ours else 8, label="ours" if ours else label.replace("\n", " "))
    for nanoseconds, error, wrong in data:
        if wrong:
            axes.plot([nanoseconds], [error], marker, color=colour, markersize=8, zorder=3, markerfacecolor="white",
                      markeredgewidth=1.6)


@picture("speed_accuracy", name="speed_accuracy")
def draw(tables):
    rows, scene, error = tables.strings("speed_accuracy"), "all", "error_median"
    figure, axes = style.new(10.2, 8.2, constrained_layout=False)
    figure.subplots_adjust(left=0.1, right=0.96, top=0.95, bottom=0.29)
    names = [name for name in METHODS if points(rows, name, scene, error)]
    names += sorted({row["method"] for row in rows} - set(METHODS))
    for name in names:
        data = points(rows, name, scene, error)
        if data:
            draw_method(axes, name, data)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1e2, 1e7)
    axes.set_ylim(3e-17, 20)
    axes.set_xticks([1e2, 1e3, 1e4, 1e5, 1e6, 1e7])
    axes.set_xticklabels(["100 ns", "1 µs", "10 µs", "100 µs", "1 ms", "10 ms"])
    axes.grid(which="major", color="#dddddd", linewidth=0.8)
    axes.set_axisbelow(True)
    axes.set_ylabel("error of one flight, median  (a, τ)")
    axes.set_xlabel("processor time per impact")
    axes.set_title("The same flights, truth in 113 bits", fontsize=14)
    axes.plot([], [], "o", color="#444444", markerfacecolor="white", markeredgewidth=1.6,
              label="open: missed or phantom impacts")
    figure.legend(loc="lower center", ncol=3, fontsize=11, frameon=False, markerscale=0.75, handlelength=2.6)
    return figure

"""Speed against accuracy: time per impact against the error of impact time and state. A point for each setting of a
method, a line for each method, with its name beside it. An open point has missed impacts, or found some that are none.
"""
import math

from registry import picture

from . import style
from .methods import METHODS, method_style

# where the name of a method stands: which of its points, and the offset from it [points]
NAMES = {"exact": (0, (0, -20), "center"), "certified_plain": (0, (9, -2), "left"),
         "sampled_toms748": (2, (-14, 11), "center"), "heyoka": (0, (-4, 11), "center"),
         "odeint_dopri5": (-1, (-8, -2), "right"), "odeint_bulirsch_stoer": (-1, (6, -11), "left"),
         "cvode_adams": (-1, (2, -13), "center"), "cvode_bdf": (-1, (9, -2), "left"), "siconos": (-1, (8, -2), "left"),
         "rk4": (-1, (-7, -7), "right"), "moreau_jean": (-1, (8, 4), "left"), "semi_implicit_euler": (-1, (8, -9), "left"),
         "penalty": (1, (4, 11), "center")}
SUFFIX = "_minima"  # the same method, with the gap rate as a second event: beside it, dashed


def points(rows, method, scene, error):
    chosen = [row for row in rows if row["method"] == method and row["scene"] == scene]
    values = [(float(r["ns_per_impact"]), float(r[error]), int(r["missed"]) + int(r["phantom"])) for r in chosen]
    return [v for v in values if math.isfinite(v[1]) and v[1] > 0]


def draw_method(axes, name, data):
    label, colour, marker = method_style(name)
    ours = name == "exact"
    axes.plot([d[0] for d in data], [d[1] for d in data], color=colour, linewidth=1.4, zorder=2,
              linestyle="--" if name.endswith(SUFFIX) else "-", marker=marker, markersize=18 if ours else 7)
    for nanoseconds, error, wrong in data:
        if wrong:
            axes.plot([nanoseconds], [error], marker, color=colour, markersize=7, zorder=3, **style.OPEN)
    if name in NAMES:
        at, offset, align = NAMES[name]
        axes.annotate(label.replace("\n", " "), data[at][:2], xytext=offset, textcoords="offset points", color=colour,
                      ha=align, va="center", fontweight="bold" if ours else None)


@picture("speed_accuracy", name="speed_accuracy")
def draw(tables):
    rows, scene, error = tables.strings("speed_accuracy"), "all", "error_median"
    figure, axes = style.new(6.4)
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
    axes.set_ylabel(r"error of one flight, median [a, $\tau$, a/$\tau$]")
    axes.set_xlabel("processor time per impact")
    axes.annotate("better", (1.3e2, 1e-8), xytext=(4.5e2, 1e-6), color=style.GREY, ha="left", va="bottom",
                  arrowprops=dict(arrowstyle="-|>", color=style.GREY))
    figure.suptitle("Error against 113-bit arithmetic, on the same flights for every method.  "
                    "Open: impacts missed, or found where there are none.\nDashed: the same method with the gap rate "
                    "as a second event.", fontsize=10)
    return figure

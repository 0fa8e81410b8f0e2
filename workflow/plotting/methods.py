"""Methods compared: what a result costs against how wrong it is."""
import math

from registry import picture

from . import style

SUFFIX = "_minima"  # the same method, with the gap rate as a second event: dashed
# name in the tables: (name on charts, colour, marker)
METHODS = {
    "exact": ("this emulator", "#D55E00", "*"),
    "exact_one_by_one": ("this emulator,\nevery bounce", "#D55E00", "*"),
    "certified_plain": ("plain certified loop", "#D55E00", "h"),
    "sampled_toms748": ("exact flow, sampled", "#000000", "s"),
    "sampled_minima": ("exact flow, sampled,\nwith minima", "#000000", "d"),
    "heyoka": ("heyoka", "#AA3377", "H"),
    "odeint_dopri5": ("dopri5", "#0072B2", "o"),
    "odeint_dopri5_minima": ("dopri5\nwith minima", "#0072B2", "8"),
    "odeint_bulirsch_stoer": ("Bulirsch-Stoer", "#56B4E9", "v"),
    "cvode_adams": ("CVODE Adams", "#009E73", "^"),
    "cvode_adams_minima": ("CVODE Adams\nwith minima", "#009E73", "2"),
    "cvode_bdf": ("CVODE BDF", "#009E73", "D"),
    "siconos": ("Siconos", "#882255", "p"),
    "rk4": ("RK4", "#CC79A7", "P"),
    "moreau_jean": ("Moreau-Jean", "#E69F00", "X"),
    "semi_implicit_euler": ("semi-implicit Euler", "#8A7A00", "<"),
    "penalty": ("penalty spring", "#666666", ">"),
}
BETTER = dict(color=style.GREY, arrowprops=dict(arrowstyle="-|>", color=style.GREY))


def method_style(name):
    return METHODS.get(name, (name, "#999999", "."))


# eta = 3.4 is left out: nearly all methods agree there within the spread of chaotic runs (docs/accuracy.md)
PACE_SCENES = [("kf_2", r"$\eta$ = 2: against the closed form"),
               ("kf_3", r"$\eta$ = 3, $v_c$ = 0.01 $\eta$: 600 bounces in a $\tau$")]
LEAST, MOST = 1e-15, 1e2  # errors outside are drawn at the edge


def draw_pace(axes, rows, scene, title):
    chosen = [row for row in rows if row["scene"] == scene]
    for name in [name for name in METHODS if name in {row["method"] for row in chosen}]:
        label, colour, marker = method_style(name)
        data = [(float(r["seconds_per_second"]), float(r["k_f_error"])) for r in chosen if r["method"] == name]
        if name == "exact" and scene == "kf_3":  # every bounce by itself is the reference
            data = [point for point in data if point[1] > 0.0]
        data = [(x, min(MOST, max(LEAST, y)) if math.isfinite(y) else MOST) for x, y in data]
        axes.plot(*zip(*data), color=colour, marker=marker, markersize=13 if name == "exact" else 6, linewidth=1.1,
                  linestyle="--" if name.endswith(SUFFIX) else "-", label=label.replace("\n", " "))
    axes.axvline(1.0, color="#222222", linewidth=1.3)
    axes.text(0.85, 2e-13, "real time", rotation=90, va="bottom", ha="right")
    axes.set(xscale="log", yscale="log", ylim=(LEAST, MOST * 3))
    axes.set_title(title)
    axes.set_xlabel("processor seconds for a second of model time")


@picture("pace")
def pace(tables):
    """Which method can run an emulator: processor time per second of model time against the error of K_f. Left of the
    line at 1 a method keeps up with the tip.
    """
    rows = tables.strings("pace")
    figure, panels = style.new(5.6, 1, 2, sharey=True, constrained_layout=False)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.94, bottom=0.31, wspace=0.06)
    for axes, (scene, title) in zip(panels, PACE_SCENES):
        draw_pace(axes, rows, scene, title)
    panels[0].set_ylabel("relative error of $K_f$ (at the top: no result)")
    panels[0].annotate("better", (4.5e-3, 1e-9), xytext=(1.6e-2, 1e-7), **BETTER)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="lower center", ncol=4)
    return figure


# where the name of a method stands: which of its points, and the offset from it [points]
NAMES = {"exact": (0, (0, -20), "center"), "certified_plain": (0, (9, -2), "left"),
         "sampled_toms748": (2, (-14, 11), "center"), "heyoka": (0, (-4, 11), "center"),
         "odeint_dopri5": (-1, (-8, -2), "right"), "odeint_bulirsch_stoer": (-1, (6, -11), "left"),
         "cvode_adams": (-1, (2, -13), "center"), "cvode_bdf": (-1, (9, -2), "left"), "siconos": (-1, (8, -2), "left"),
         "rk4": (-1, (-7, -7), "right"), "moreau_jean": (-1, (8, 4), "left"), "semi_implicit_euler": (-1, (8, -9), "left"),
         "penalty": (1, (4, 11), "center")}


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


@picture("speed_accuracy")
def speed_accuracy(tables):
    """Time per impact against the error of impact time and state: a point for each setting of a method, a line for each
    method, with its name beside it. An open point has missed impacts, or found some that are none.
    """
    rows, scene, error = tables.strings("speed_accuracy"), "all", "error_median"
    figure, axes = style.new(6.4)
    names = [name for name in METHODS if points(rows, name, scene, error)]
    names += sorted({row["method"] for row in rows} - set(METHODS))
    for name in names:
        data = points(rows, name, scene, error)
        if data:
            draw_method(axes, name, data)
    axes.set(xscale="log", yscale="log", xlim=(1e2, 1e7), ylim=(3e-17, 20))
    axes.set_xticks([1e2, 1e3, 1e4, 1e5, 1e6, 1e7])
    axes.set_xticklabels(["100 ns", "1 µs", "10 µs", "100 µs", "1 ms", "10 ms"])
    axes.set(ylabel=r"error of one flight, median [a, $\tau$, a/$\tau$]", xlabel="processor time per impact")
    axes.annotate("better", (1.3e2, 1e-8), xytext=(4.5e2, 1e-6), ha="left", va="bottom", **BETTER)
    figure.suptitle("Error against 113-bit arithmetic, on the same flights for every method.  "
                    "Open: impacts missed, or found where there are none.\nDashed: the same method with the gap rate "
                    "as a second event.", fontsize=10)
    return figure

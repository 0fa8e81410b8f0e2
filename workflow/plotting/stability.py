"""The matrix of methods against scenes."""
from collections import OrderedDict

from matplotlib.patches import Rectangle

from registry import picture

from . import style
from .methods import METHODS, method_style

# from the table's verdict: colour (Okabe and Ito, in order of lightness), sign, colour of what is written on it, and
# what the number means, the same in every row
VERDICTS = OrderedDict([
    ("right", ("#009E73", "✓", "white", "right: error")),
    ("inaccurate", ("#F0E442", "≈", "black", "inaccurate: error")),
    ("misses", ("#E69F00", "○", "black", "misses: % of the impacts")),
    ("phantom", ("#CC79A7", "+", "black", "phantom: % of the impacts")),
    ("stalls", ("#444444", "‖", "white", "stalls: % of the scene done")),
    ("blows up", ("#D55E00", "✕", "white", "blows up: model time until then")),
])

TITLES = {
    "even": "η = 2, 4, 6, 8", "glide": "η = 1, gliding", "rest": "$v_0$ = 0",
    "splash_3_0.1": "η = 3, $v_c$ = 0.1 η", "splash_3_0.03": "η = 3, $v_c$ = 0.03 η",
    "splash_3_0.01": "η = 3, $v_c$ = 0.01 η",
    "splash_3_0.003": "η = 3, $v_c$ = 0.003 η", "splash_3_0.001": "η = 3, $v_c$ = 0.001 η",
    "splash_5_0.1": "η = 5, $v_c$ = 0.1 η", "splash_5_0.01": "η = 5, $v_c$ = 0.01 η",
    "splash_5_0.001": "η = 5, $v_c$ = 0.001 η",
    "eta_0.5": "η = 0.5", "eta_0.2": "η = 0.2", "gamma_0.1": "γ = 0.1", "gamma_0.01": "γ = 0.01",
    "gamma_0": "γ = 0",
    "gamma_1": "γ = 1, 1e5 impacts", "hour": "one hour", "large_steps": "large steps, η = 7.5",
    "commands": "commands in flight", "eta_50": "η = 50", "crest_0.9": "holder at 0.9 H",
    "crest_0.999": "holder at 0.999 H",
    "steep": "ten times steeper",
}


def title(scene):
    return "graze, %s $v_0$" % scene[len("graze_"):] if scene.startswith("graze_") else TITLES.get(scene, scene)


def short(value):
    number = float(value)
    if number == 0 or (0.01 <= abs(number) < 1000):
        return "%.3g" % number
    mantissa, exponent = ("%.0e" % number).split("e")
    return "%se%d" % (mantissa, int(exponent))


def percent(value):
    return "%.0f%%" % value if value >= 1 or value < 0.05 else "%.1g%%" % value


def number(row):
    """Of a cell, as the legend says."""
    value, meaning = float(row["number"]), row["meaning"]
    if row["verdict"] in ("misses", "phantom"):
        return percent(100 * value / int(meaning.rsplit(" ", 1)[1]))
    if row["verdict"] == "stalls":
        if meaning.startswith("times"):  # as long as the tip itself takes
            return percent(100 / value)
        whole = meaning.rsplit(" ", 1)[-1]
        return percent(100 * value / float(whole)) if whole.isdigit() else ""
    return short(value)


def threshold(row):
    """Which error is still right in a row."""
    limit = row.get("right_below")
    if not limit:
        return ""
    kind = "K_f" if "K_f" in row["meaning"] else "energy" if "energy" in row["meaning"] else "state"
    return "%s %s" % (kind, percent(100 * float(limit)) if float(limit) > 0.01 else short(limit))


def draw_cell(axes, column, line, row):
    colour, sign, ink, _ = VERDICTS[row["verdict"]]
    axes.add_patch(Rectangle((column, line), 0.96, 0.92, color=colour, linewidth=0))
    axes.text(column + 0.48, line + 0.46, "%s %s" % (sign, number(row)), ha="center", va="center", color=ink,
              fontsize=11)


def row_label(scene, rows):
    """Title and threshold: a scene's meaning stands in the cell of a method that came through."""
    limits = [threshold(row) for row in rows if row["scene"] == scene and row["verdict"] in ("right", "inaccurate")]
    return "%s  (%s)" % (title(scene), limits[0]) if limits and limits[0] else title(scene)


@picture("stability", name="stability")
def draw(tables):
    rows = tables.strings("stability")
    scenes = list(OrderedDict((row["scene"], None) for row in rows))
    present = {row["method"] for row in rows}
    methods = [m for m in METHODS if m in present] + sorted(present - set(METHODS))
    width, height = 0.92 * len(methods) + 4.6, 0.36 * len(scenes) + 3.4
    figure, axes = style.new(width, height, constrained_layout=False)
    figure.subplots_adjust(left=3.2 / width, right=1 - 1.0 / width, top=1 - 2.0 / height, bottom=1.0 / height)
    for row in rows:
        draw_cell(axes, methods.index(row["method"]), scenes.index(row["scene"]), row)
    axes.set_xlim(-0.02, len(methods))
    axes.set_ylim(len(scenes), -0.05)
    axes.set_yticks([i + 0.46 for i in range(len(scenes))])
    axes.set_yticklabels([row_label(scene, rows) for scene in scenes])
    axes.set_xticks([i + 0.48 for i in range(len(methods))])
    axes.set_xticklabels([method_style(m)[0].replace("\n", " ") for m in methods], rotation=32, ha="left",
                         rotation_mode="anchor")
    if "exact" in methods:
        axes.get_xticklabels()[methods.index("exact")].set_fontweight("bold")
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    handles = [Rectangle((0, 0), 1, 1, color=colour) for colour, _, _, _ in VERDICTS.values()]
    figure.legend(handles, ["%s %s" % (sign, text) for _, sign, _, text in VERDICTS.values()], loc="lower center",
                  ncol=3, fontsize=12,
                  frameon=False)
    return figure

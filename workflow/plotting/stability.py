"""The matrix of methods against scenes."""
from matplotlib.patches import Rectangle

from registry import picture

from . import style
from .methods import METHODS, method_style

# from the table's verdict: colour, sign, colour of the sign, and what it means. The numbers are in docs/data/stability.csv.
VERDICTS = {
    "right": ("#009E73", "✓", "white", "right"),
    "inaccurate": ("#F0E442", "≈", "black", "inaccurate"),
    "misses": ("#E69F00", "○", "black", "misses impacts"),
    "phantom": ("#CC79A7", "+", "black", "finds impacts that are none"),
    "stalls": ("#444444", "‖", "white", "stalls"),
    "blows up": ("#D55E00", "✕", "white", "blows up"),
}

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


def percent(value):
    return "%.0f%%" % value if value >= 1 or value < 0.05 else "%.1g%%" % value


def threshold(row):
    """Which error is still right in a row."""
    limit = row.get("right_below")
    if not limit:
        return ""
    kind = "$K_f$" if "K_f" in row["meaning"] else "energy" if "energy" in row["meaning"] else "state"
    small = ("%.0e" % float(limit)).replace("e-0", "e-")
    return "%s %s" % (kind, percent(100 * float(limit)) if float(limit) > 0.01 else small)


def draw_cell(axes, column, line, row):
    colour, sign, ink, _ = VERDICTS[row["verdict"]]
    axes.add_patch(Rectangle((column, line), 0.95, 0.92, color=colour, linewidth=0))
    axes.text(column + 0.475, line + 0.46, sign, ha="center", va="center", color=ink)


def row_label(scene, rows):
    """Title and threshold: a scene's meaning stands in the cell of a method that came through."""
    limits = [threshold(row) for row in rows if row["scene"] == scene and row["verdict"] in ("right", "inaccurate")]
    return "%s  (%s)" % (title(scene), limits[0]) if limits and limits[0] else title(scene)


@picture("stability", name="stability")
def draw(tables):
    rows = tables.strings("stability")
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    present = {row["method"] for row in rows}
    methods = [m for m in METHODS if m in present] + sorted(present - set(METHODS))
    height = 0.215 * len(scenes) + 2.5
    figure, axes = style.new(height, constrained_layout=False)
    figure.subplots_adjust(left=0.26, right=0.94, top=1 - 1.85 / height, bottom=0.6 / height)
    for row in rows:
        draw_cell(axes, methods.index(row["method"]), scenes.index(row["scene"]), row)
    axes.set(xlim=(-0.02, len(methods)), ylim=(len(scenes), -0.05))
    axes.set_yticks([i + 0.46 for i in range(len(scenes))])
    axes.set_yticklabels([row_label(scene, rows) for scene in scenes])
    axes.set_xticks([i + 0.4 for i in range(len(methods))])
    axes.set_xticklabels([method_style(m)[0].replace("\n", " ") for m in methods], rotation=48, ha="left",
                         rotation_mode="anchor")
    if "exact" in methods:
        axes.get_xticklabels()[methods.index("exact")].set_fontweight("bold")
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    axes.grid(False)
    axes.set_frame_on(False)
    handles = [Rectangle((0, 0), 1, 1, color=colour) for colour, _, _, _ in VERDICTS.values()]
    figure.legend(handles, ["%s %s" % (sign, text) for _, sign, _, text in VERDICTS.values()], loc="lower center",
                  ncol=6, columnspacing=1.2, handlelength=1.2)
    return figure

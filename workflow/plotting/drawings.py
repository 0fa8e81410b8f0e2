"""Drawings: from the cantilever to the model; model time, batches and wall time; nodes and topics."""
import math
import re
from pathlib import Path

from matplotlib.patches import FancyBboxPatch, Polygon, Rectangle

from registry import picture

from . import style
from .model import arrow, spring

INTERFACE = Path(__file__).resolve().parents[2] / "docs/interface.md"
METAL = "#bbbbbb"


def wave(axes, low, high, level, amplitude=0.05, length=0.3):
    xs = [low + (high - low) * i / 300 for i in range(301)]
    ys = [level + amplitude * math.cos(style.TWO_PI * (x - low) / length) for x in xs]
    axes.fill_between(xs, ys, level - 0.16, color=style.SOLID)
    axes.plot(xs, ys, color=style.GREY, linewidth=1.3)


def draw_side(axes):
    """The lever bends: its tip goes up and down."""
    axes.add_patch(Rectangle((0.0, 0.86), 0.3, 0.22, color=style.ORANGE))
    axes.text(0.15, 1.14, "holder", color=style.ORANGE, ha="center")
    xs = [0.3 + 0.75 * i / 50 for i in range(51)]
    for bend, alpha in ((0.0, 0.35), (0.12, 1.0)):
        ys = [0.94 + bend * ((x - 0.3) / 0.75) ** 2 - 0.18 * (x - 0.3) for x in xs]
        axes.fill_between(xs, [y - 0.025 for y in ys], [y + 0.025 for y in ys], color=METAL, alpha=alpha, linewidth=0)
        axes.add_patch(Polygon([(0.93, ys[-1]), (1.05, ys[-1]), (1.0, ys[-1] - 0.42)], color=METAL, alpha=alpha))
    wave(axes, 0.35, 1.25, 0.38)
    arrow(axes, (1.12, 0.6), (1.12, 0.9), "bends: $k_v$", (1.12, 1.0), style.BLUE, both=True)
    axes.text(0.6, 0.12, "from the side", ha="center")


def draw_front(axes, left=1.75):
    """The lever twists: its tip goes to and fro along the scan."""
    for angle, alpha in ((0.0, 0.35), (0.28, 1.0)):
        c, s = math.cos(angle), math.sin(angle)

        def rotated(x, y, c=c, s=s):
            return left + 0.3 + c * x - s * y, 0.92 + s * x + c * y

        corners = [rotated(x, y) for x, y in ((-0.22, -0.025), (0.22, -0.025), (0.22, 0.025), (-0.22, 0.025))]
        axes.add_patch(Polygon(corners, color=METAL, alpha=alpha))
        point = [rotated(-0.06, -0.02), rotated(0.06, -0.02), rotated(0.0, -0.44)]
        axes.add_patch(Polygon(point, color=METAL, alpha=alpha))
    wave(axes, left - 0.25, left + 0.85, 0.38)
    arrow(axes, (left + 0.14, 0.62), (left + 0.6, 0.62), "twists: $k_h$", (left + 0.7, 0.72), style.BLUE, both=True)
    arrow(axes, (left + 0.15, 1.1), (left + 0.5, 1.1), "scan at $v_0$", (left + 0.33, 1.18), style.ORANGE)
    axes.text(left + 0.3, 0.12, "along the lever", ha="center")


def draw_model(axes, left=3.2):
    holder, tip = (left + 0.1, 0.52), (left + 0.5, 0.92)
    axes.plot([holder[0], holder[0], tip[0] + 0.05], [tip[1] + 0.1, holder[1], holder[1]], color=style.ORANGE, linewidth=2.2)
    spring(axes, (holder[0], tip[1]), tip)
    spring(axes, (tip[0], holder[1]), tip, turns=6, width=0.03)
    axes.plot(*tip, "o", color=style.BLUE, markersize=12)
    axes.text(tip[0] + 0.06, tip[1] + 0.02, "$m$", color=style.BLUE)
    axes.text(left + 0.3, tip[1] - 0.06, "$k_h$", ha="center", va="top")
    axes.text(tip[0] + 0.07, 0.7, "$k_v$", va="center")
    arrow(axes, (holder[0], tip[1] + 0.1), (holder[0] + 0.3, tip[1] + 0.1), "$v_0$", (holder[0] + 0.37, tip[1] + 0.1),
          style.ORANGE)
    wave(axes, left - 0.15, left + 0.9, 0.38)
    axes.text(left + 0.37, 0.12, "the model", ha="center")


@picture()
def cantilever(_):
    figure, axes = style.new(3.0)
    draw_side(axes)
    draw_front(axes)
    draw_model(axes)
    for x, sign in ((1.4, "+"), (2.83, "=")):
        axes.text(x, 0.66, sign, ha="center", va="center", fontsize=18)
    axes.set(xlim=(-0.05, 4.15), ylim=(0.05, 1.28))
    style.bare(axes)
    return figure


def draw_track(axes, level, name, note):
    axes.text(-0.12, level, name, ha="right", va="center", fontweight="bold")
    axes.text(-0.12, level - 0.2, note, ha="right", va="center", color=style.GREY, fontsize=style.SMALL)
    axes.annotate("", (4.55, level - 0.32), xytext=(0, level - 0.32),
                  arrowprops=dict(arrowstyle="-|>", color=style.GREY, linewidth=1.0))


def draw_bounces(axes, level):
    begins = [0.0, 0.31, 0.55, 0.98, 1.2, 1.63, 2.05, 2.22, 2.6, 2.95, 3.3, 3.72, 3.9, 4.3]
    for i, (begin, end) in enumerate(zip(begins, begins[1:])):
        height = 1.6 * (end - begin) ** 1.2
        xs = [begin + (end - begin) * k / 30 for k in range(31)]
        axes.plot(xs, [level - 0.3 + height * 4 * (k / 30) * (1 - k / 30) * 0.75 for k in range(31)], color=style.BLUE,
                  linewidth=1.4)
        if i:
            axes.plot(begin, level - 0.3, "o", color=style.BLUE, markersize=4)


@picture()
def model_time(_):
    figure, axes = style.new(4.6)
    draw_track(axes, 2.6, "model time", r"exact: whole $\tau$ and phase")
    draw_bounces(axes, 2.6)
    draw_track(axes, 1.35, "batches", "a 100th of a second each")
    for i in range(4):
        changed = i >= 2
        axes.add_patch(FancyBboxPatch((i + 0.04, 1.12), 0.92, 0.4, boxstyle="round,pad=0,rounding_size=0.04",
                                      facecolor="#cfe3f1" if not changed else "#f8dccb", edgecolor=style.GREY))
        axes.text(i + 0.5, 1.32, "samples, impacts,\nfriction", ha="center", va="center", fontsize=style.SMALL)
        axes.plot([i, i], [1.03, 3.1], ":", color=style.GREY, linewidth=0.8)
    axes.plot([4, 4], [1.03, 3.1], ":", color=style.GREY, linewidth=0.8)
    draw_track(axes, 0.1, "wall time", "header.stamp")
    for i in range(4):
        axes.annotate("", (i + 1.06, -0.2), xytext=(i + 0.96, 1.1), arrowprops=dict(arrowstyle="-|>", color=style.BLUE))
    axes.text(4.12, 0.55, "published\nat its end", color=style.BLUE, va="center")
    axes.annotate("command", (1.45, -0.22), xytext=(1.45, -0.52), ha="right", color=style.ORANGE,
                  arrowprops=dict(arrowstyle="-|>", color=style.ORANGE))
    axes.annotate("", (2.0, 1.02), xytext=(1.47, -0.2), arrowprops=dict(arrowstyle="-|>", color=style.ORANGE,
                                                                      linestyle="--"))
    axes.text(1.52, -0.45, "takes effect at the next boundary; ~applied gives its exact model time", color=style.ORANGE,
              ha="left", va="center", fontsize=style.SMALL)
    axes.annotate("", (2.0, 3.22), xytext=(1.0, 3.22), arrowprops=dict(arrowstyle="<->", color="black"))
    axes.text(1.5, 3.32, r"63.7 $\tau$ of mica at time_scale 1", ha="center", va="bottom")
    axes.set(xlim=(-1.35, 4.85), ylim=(-0.75, 3.6))
    axes.axis("off")
    return figure


def table_below(text, header):
    """Rows of a table of docs/interface.md, of which the test `interface` holds that the nodes have just these names."""
    lines = text[text.index("| %s |" % header):].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def box(axes, x, y, width, height, text, colour, bold=False):
    axes.add_patch(FancyBboxPatch((x, y), width, height, boxstyle="round,pad=0,rounding_size=0.08", facecolor=colour,
                                  edgecolor=style.GREY))
    axes.text(x + 0.5 * width, y + 0.5 * height, text, ha="center", va="center", fontweight="bold" if bold else None)


def named(axes, names, x, top, align):
    for i, name in enumerate(names):
        axes.text(x, top - 0.27 * i, name, ha=align, va="center", family="monospace", fontsize=style.SMALL)


@picture()
def nodes(_):
    text = INTERFACE.read_text()
    topics = table_below(text, "direction | topic | type | latched | when")
    received = [row[1].strip("`") for row in topics if row[0] == "in"]
    published = [row[1].strip("`") for row in topics if row[0] == "out"]
    services = [row[0].strip("`") for row in table_below(text, "service | type | what it does")]
    sent = [name for name in published if name.startswith("~") and "parameter" not in name]
    live = [name for name in published if "parameter" in name] + [name for name in services if "parameters" in name]
    services = [name for name in services if name not in live]
    figure, axes = style.new(5.0)
    pale, line = "#f2f2f2", dict(arrowstyle="-|>", color=style.GREY, shrinkA=0, shrinkB=0)
    box(axes, 3.75, 0.1, 1.5, 4.8, "emulator_node\n/afm", "#cfe3f1", bold=True)
    for y, height, who, kind, names in ((3.75, 1.15, "your controller,\nrostopic pub", "topics", received),
                                        (1.55, 1.75, "your controller,\nrosservice call", "services", services),
                                        (0.1, 0.95, "rqt_reconfigure", "topics and a service", live)):
        middle = y + 0.5 * height
        box(axes, 0.0, y, 1.5, height, who, pale)
        axes.text(2.6, middle + 0.135 * len(names) + 0.11, kind, ha="center", va="center", color=style.GREY,
                  fontsize=style.SMALL)
        named(axes, names, 2.6, middle + 0.135 * (len(names) - 1), "center")
        axes.annotate("", (3.73, middle), xytext=(3.48, middle), arrowprops=line)
        axes.plot([1.52, 1.72], [middle, middle], color=style.GREY, linewidth=1.0)
    for y, height, who, names in ((2.9, 2.0, "your subscriber,\npanel /afm_panel,\nview_node /afm_view", sent),
                                  (1.1, 0.6, "rqt_runtime_monitor", ["/diagnostics"]),
                                  (0.1, 0.6, "replay_check,\nbag_check", ["bags"])):
        middle = y + 0.5 * height
        box(axes, 7.3, y, 1.75, height, who, pale)
        named(axes, names, 6.3, middle + 0.135 * (len(names) - 1), "center")
        axes.plot([5.27, 5.52], [middle, middle], color=style.GREY, linewidth=1.0)
        axes.annotate("", (7.28, middle), xytext=(7.05, middle), arrowprops=line)
    box(axes, 8.3, 1.95, 0.75, 0.45, "rviz", pale)
    axes.annotate("", (8.68, 2.42), xytext=(8.68, 2.88), arrowprops=line)
    named(axes, ["/afm_view/markers"], 8.6, 2.64, "right")
    axes.text(6.3, 4.98, "topics", ha="center", va="center", color=style.GREY, fontsize=style.SMALL)
    axes.set(xlim=(-0.05, 9.1), ylim=(0.0, 5.05))
    axes.axis("off")
    return figure

"""One look for all figures: drawn for a page of 900 pixels, no text below 9 points there, colours that the colour-blind
can tell apart (Okabe and Ito), and the model's constants.
"""
import math
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError as error:
    sys.exit("plotting: %s (Debian and Ubuntu: apt-get install python3-matplotlib)" % error)

BLUE, ORANGE, GREEN, PINK, SKY, YELLOW = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#F0E442"
AMBER = "#E69F00"
GREY, PALE = "#555555", "#dddddd"
SOLID = "#e6e6e6"  # of the surface
PAGE = 9.375  # [inches] at 96 dots each these are the 900 pixels of a page, and a point here is a point there
DOTS = 144  # an inch in the file, for finer screens
SMALL = 9  # [points] the least text
TWO_PI = 2.0 * math.pi
AMPLITUDE = 0.05 / 0.52  # of the surface [a]
RATIO = 6.25  # omega_h / omega_v
S = TWO_PI * AMPLITUDE
# the paper's axis: energy in units of m, a and 1/omega_h, time in 1/omega_h, velocity in units of eta
PAPER = 1.0 / (TWO_PI * RATIO) ** 3
K_F_LABEL = r"$K_f$ [$m_{tip}/\tau$]"
ETA_LABEL = r"drag speed $\eta$ [$a/\tau$]"
# one tip, its drag speed raised or lowered slowly
SWEEPS = {"up": dict(color=BLUE, linestyle="-", linewidth=1.5, label=r"$\eta$ rising slowly"),
          "down": dict(color=ORANGE, linestyle=(0, (3, 1.5)), linewidth=1.3, label=r"$\eta$ falling slowly")}
# an open marker
OPEN = dict(markerfacecolor="white", markeredgewidth=1.3)


def closed_form(gamma):
    """K_f at even eta [m_tip/tau]."""
    return 4.0 * (1.0 + gamma) / (1.0 - gamma) * S * S / (1.0 + S * S)


def set_look():
    pyplot.rcParams.update({
        "font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "figure.titlesize": 11, "legend.fontsize": SMALL,
        "xtick.labelsize": SMALL, "ytick.labelsize": SMALL, "legend.frameon": False, "mathtext.fontset": "dejavusans",
        "axes.grid": True, "grid.color": PALE, "grid.linewidth": 0.6, "axes.axisbelow": True, "savefig.dpi": DOTS,
        "axes.prop_cycle": matplotlib.cycler(color=[BLUE, ORANGE, GREEN, PINK, "black", SKY])})


def figure(height):
    set_look()
    return pyplot.figure(figsize=(PAGE, height), constrained_layout=True)


def new(height, rows=1, columns=1, constrained_layout=True, **options):
    set_look()
    return pyplot.subplots(rows, columns, figsize=(PAGE, height), constrained_layout=constrained_layout, **options)


def legend_above(axes, columns=3, **options):
    """Where it hides nothing."""
    return axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=columns, borderaxespad=0.1, **options)


def legend_of_all(figure, handles, columns, **options):
    """Above all axes. handles: by their labels."""
    figure.suptitle(" ", fontsize=14)  # room for it
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=columns, **options)


def bare(axes):
    """Of a drawing: no frame, no axes, one scale."""
    axes.axis("off")
    axes.set_aspect(1)

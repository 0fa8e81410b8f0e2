"""One look for all figures: colours that the colour-blind can tell apart (Okabe and Ito), and the model's constants."""
import math
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError as error:
    sys.exit("plotting: %s (Debian and Ubuntu: apt-get install python3-matplotlib)" % error)

BLUE, ORANGE, GREEN, PINK, SKY, YELLOW = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#F0E442"
GREY = "#555555"
TWO_PI = 2.0 * math.pi
AMPLITUDE = 0.05 / 0.52  # of the surface [a]
RATIO = 6.25  # omega_h / omega_v
S = TWO_PI * AMPLITUDE
# the paper's axis: energy in units of m, a and 1/omega_h, time in 1/omega_h, velocity in units of eta
PAPER = 1.0 / (TWO_PI * RATIO) ** 3
K_F_LABEL = r"$K_f$ [$m_{tip}/\tau$]"
ETA_LABEL = r"drag speed $\eta = v_0 \tau / a$"
# one tip, its drag speed raised or lowered slowly
SWEEPS = {"up": dict(color=BLUE, linestyle="-", linewidth=1.5, label=r"$\eta$ rising"),
          "down": dict(color=ORANGE, linestyle=(0, (3, 1.5)), linewidth=1.3, label=r"$\eta$ falling")}


def closed_form(gamma):
    """K_f at even eta [m_tip/tau]."""
    return 4.0 * (1.0 + gamma) / (1.0 - gamma) * S * S / (1.0 + S * S)


def set_look():
    pyplot.rcParams.update({"font.size": 11, "axes.titlesize": 12, "mathtext.fontset": "dejavusans", "savefig.dpi": 110,
                            "svg.hashsalt": "afm_emulator"})


# inches at 110 dots each: a page shows 900 pixels
def figure(width, height):
    set_look()
    return pyplot.figure(figsize=(width, height), constrained_layout=True)


def new(width=8.0, height=5.0, rows=1, columns=1, constrained_layout=True, **options):
    set_look()
    return pyplot.subplots(rows, columns, figsize=(width, height), constrained_layout=constrained_layout, **options)


def legend_above(axes, columns=3, **options):
    """Where it hides nothing."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=columns, frameon=False, borderaxespad=0.1,
                fontsize=9, **options)

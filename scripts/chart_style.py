"""What the charts of methods share: names, colours that the colour-blind can tell apart (Okabe and Ito), files."""
import csv
import sys
from collections import OrderedDict
from pathlib import Path

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError as error:
    sys.exit("%s: %s (Debian and Ubuntu: apt-get install python3-matplotlib)" % (sys.argv[0], error))

ROOT = Path(__file__).resolve().parent.parent

# name in the tables: (name on charts, colour, marker)
METHODS = OrderedDict([
    ("exact", ("ours", "#D55E00", "*")),
    ("exact_one_by_one", ("ours, bounces\none by one", "#D55E00", "*")),
    ("sampled_toms748", ("exact flow, sampled\n+ TOMS 748", "#000000", "s")),
    ("odeint_dopri5", ("odeint dopri5", "#0072B2", "o")),
    ("odeint_bulirsch_stoer", ("odeint Bulirsch-Stoer", "#56B4E9", "v")),
    ("cvode_adams", ("CVODE\nAdams", "#009E73", "^")),
    ("cvode_bdf", ("CVODE BDF", "#009E73", "D")),
    ("siconos", ("Siconos", "#882255", "p")),
    ("rk4", ("RK4 + TOMS 748", "#CC79A7", "P")),
    ("moreau_jean", ("Moreau-Jean", "#E69F00", "X")),
    ("semi_implicit_euler", ("semi-implicit Euler", "#8A7A00", "<")),
    ("penalty", ("penalty spring", "#666666", ">")),
])


def method_style(name):
    return METHODS.get(name, (name, "#999999", "."))


def read_rows(path):
    try:
        with open(str(path)) as table:
            rows = list(csv.DictReader(table))
    except OSError as error:
        sys.exit("%s: %s" % (sys.argv[0], error))
    if not rows:
        sys.exit("%s: %s has no rows" % (sys.argv[0], path))
    return rows


def save(figure, stem):
    """As PNG and as SVG, the same bytes for the same data."""
    pyplot.rcParams["svg.hashsalt"] = "afm_emulator"
    for kind, metadata in (("png", None), ("svg", {"Date": None})):
        path = "%s.%s" % (stem, kind)
        try:
            figure.savefig(path, dpi=110, metadata=metadata)
        except (OSError, ValueError) as error:
            sys.exit("%s: %s" % (sys.argv[0], error))
        print("wrote %s" % path)

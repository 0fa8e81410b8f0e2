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
    ("certified_plain", ("plain certified loop", "#D55E00", "h")),
    ("sampled_toms748", ("exact flow, sampled", "#000000", "s")),
    ("sampled_minima", ("exact flow, sampled,\nwith minima", "#000000", "d")),
    ("heyoka", ("heyoka", "#AA3377", "H")),
    ("odeint_dopri5", ("dopri5", "#0072B2", "o")),
    ("odeint_dopri5_minima", ("dopri5\nwith minima", "#0072B2", "8")),
    ("odeint_bulirsch_stoer", ("Bulirsch-Stoer", "#56B4E9", "v")),
    ("cvode_adams", ("CVODE Adams", "#009E73", "^")),
    ("cvode_adams_minima", ("CVODE Adams\nwith minima", "#009E73", "2")),
    ("cvode_bdf", ("CVODE BDF", "#009E73", "D")),
    ("siconos", ("Siconos", "#882255", "p")),
    ("rk4", ("RK4", "#CC79A7", "P")),
    ("moreau_jean", ("Moreau-Jean", "#E69F00", "X")),
    ("semi_implicit_euler", ("semi-implicit Euler", "#8A7A00", "<")),
    ("penalty", ("penalty spring", "#666666", ">")),
])


def method_style(name):
    return METHODS.get(name, (name, "#999999", "."))


def read_rows(path):
    try:
        with open(str(path)) as table:
            rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
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

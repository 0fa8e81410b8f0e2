"""What the charts of methods share: names, colours and markers."""
from collections import OrderedDict

# name in the tables: (name on charts, colour, marker)
METHODS = OrderedDict([
    ("exact", ("this emulator", "#D55E00", "*")),
    ("exact_one_by_one", ("this emulator,\nevery bounce", "#D55E00", "*")),
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

"""The library of afm_emulator: an AFM tip as an impact oscillator over a sinusoidal surface, exact from impact to
impact.

Units are natural: lattice spacing a, period tau = 2 pi / omega_v, tip mass m. `Units` converts to SI.

    >>> import afm
    >>> tip = afm.Tip(eta=2.0)
    >>> events = tip.advance(1000)                    # to 1000 tau: a structured array
    >>> curve = afm.friction_curve([1.8, 2.0, 2.2])   # columns as of the tool friction_curve

- Tip, Ensemble, Run: one tip; many on threads; a run in batches, as the node runs it
- Model, Bath, Units: what they are made of
- friction_curve, attractors, periodic_orbits, next_impact: what the tools of these names compute
- lyapunov: the Lyapunov exponents of a run
- kicks_lock, suitable_kicks: whether the kicks of a bath falsify K_f, and a rate that does not
- from_bag: a recording: its model, its commands, and its run simulated again

Two estimates of the friction coefficient K_f: k_f_work from the work of the drag, the definition of friction (Eq. 1
of the paper), and k_f from the energy lost in impacts (Eq. 6). Plot k_f_work. Without a heat bath they agree; with
one k_f is no friction, as the bath feeds the impacts: at eta = 0.1, 300 K and Q = 100 k_f is 20 times as much.

What is wrong with an argument is a ParameterError with name, value and reason. Long calls run without the GIL and
end at Ctrl-C. Models, baths, units, tips and runs can be copied, pickled, and sent to the processes of a Pool. A
copy has the bits of the original; pickling splits the motion under way in what is pickled, so that its last digits may
differ, and in a chatter sequence those below contact_tolerance.
"""
from .errors import ArgumentTypeError, ParameterError
from .values import Batch, Kind, Lyapunov, ModelTime, Samples, State
from ._afm import Bath, Ensemble, Model, Run, Tip, Units, kicks_lock, suitable_kicks
from ._afm import VERSION as __version__
from .arguments import explain, explained
from .tables import attractors, friction_curve, lyapunov, next_impact, periodic_orbits
from .recordings import Recording, from_bag

__all__ = ['ArgumentTypeError', 'Bath', 'Batch', 'Ensemble', 'Kind', 'Lyapunov', 'Model', 'ModelTime', 'ParameterError',
           'Recording', 'Run', 'Samples', 'State', 'Tip', 'Units', 'attractors', 'friction_curve', 'from_bag',
           'kicks_lock', 'lyapunov', 'next_impact', 'periodic_orbits', 'suitable_kicks', '__version__']

explain(Bath, Ensemble, Model, Run, Tip, Units)
kicks_lock, suitable_kicks = explained(kicks_lock, 'kicks_lock'), explained(suitable_kicks, 'suitable_kicks')
for _function in (kicks_lock, suitable_kicks):  # so that they can be pickled
    _function.__module__, _function.__qualname__ = 'afm', _function.__name__
del explain, explained, _function

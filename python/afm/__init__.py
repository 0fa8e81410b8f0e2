"""The library of afm_emulator: an AFM tip as an impact oscillator over a sinusoidal surface, exact from impact to impact.

Units are natural: lattice spacing a, period tau = 2 pi / omega_v, tip mass m. `Units` converts to SI.

    >>> import afm
    >>> tip = afm.Tip(eta=2.0)
    >>> events = tip.advance(1000)                    # to 1000 tau: a structured array
    >>> curve = afm.friction_curve([1.8, 2.0, 2.2])   # columns as of the tool friction_curve

Tip, Emulator           one tip; a run in batches, as the node runs it
Model, Bath, Units      what they are made of
friction_curve, attractors, periodic_orbits, lyapunov, next_impact     what the tools of these names compute
from_bag                a recording: its model, its commands, and its run simulated again

What is wrong with an argument is a ParameterError with name, value and reason. Long calls use threads without the GIL and end
at Ctrl-C.
"""
from .errors import ParameterError
from .values import Batch, Kind, Lyapunov, ModelTime, Samples, State
from ._afm import Bath, Emulator, Model, Tip, Units
from ._afm import VERSION as __version__
from .tables import attractors, friction_curve, lyapunov, next_impact, periodic_orbits
from .recordings import Recording, from_bag

__all__ = ['Bath', 'Batch', 'Emulator', 'Kind', 'Lyapunov', 'Model', 'ModelTime', 'ParameterError', 'Recording', 'Samples',
           'State', 'Tip', 'Units', 'attractors', 'friction_curve', 'from_bag', 'lyapunov', 'next_impact',
           'periodic_orbits', '__version__']

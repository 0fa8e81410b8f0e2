"""What the tools of these names compute, as structured arrays with the tools' columns; and Lyapunov exponents."""
from typing import Callable, Dict, Optional, Sequence, Union

import numpy as np

from . import _afm
from ._afm import Bath, Model
from .arguments import array, count, number, numbers, seed_of, thread_count
from .errors import ArgumentTypeError, ParameterError

Axis = Union[float, Sequence[float], np.ndarray]
_NAME = 'U16'  # of an attractor


def _structured(columns, rows, names=(), whole=()):
    """Rows (n, m) under the names of the columns; a column `attractor` takes the names of attractors."""
    table = np.empty(len(rows), [(c, _NAME if c == 'attractor' else 'i8' if c in whole else 'f8') for c in columns])
    values = iter(rows.T)
    for column in columns:
        table[column] = names if column == 'attractor' else next(values)
    return table


def _axes(model, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio):
    """Those that are not given are the model's."""
    given = dict(gamma=gamma, cutoff=cutoff, rest_height=rest_height, amplitude=amplitude,
                 frequency_ratio=frequency_ratio)
    return [numbers('eta', eta)] + [numbers(name, getattr(model, name) if values is None else values)
                                    for name, values in given.items()]


def _model(model: Union[str, Model]) -> Model:
    if not isinstance(model, (str, Model)):
        raise ArgumentTypeError('model', model, "must be 'oscillator', 'hammer', or a Model")
    if isinstance(model, str) and model not in ('oscillator', 'hammer'):
        raise ParameterError('model', model, 'must be oscillator or hammer')
    return Model(kind=model) if isinstance(model, str) else model


def friction_curve(eta: Axis, *, gamma: Optional[Axis] = None, cutoff: Optional[Axis] = None,
                   rest_height: Optional[Axis] = None, amplitude: Optional[Axis] = None,
                   frequency_ratio: Optional[Axis] = None, model: Union[str, Model] = 'oscillator',
                   duration: float = 10000.0, transient: float = 1000.0, sweep: str = 'fresh',
                   bath: Optional[Bath] = None, temperature: float = 0.0, quality_factor: float = 0.0,
                   lateral_quality_factor: float = 0.0, kicks_per_tau: float = Bath().kicks_per_tau,
                   seed: Optional[int] = None, threads: int = 0,
                   progress: Optional[Callable[[int, int], None]] = None) -> np.ndarray:
    """K_f against drag velocity, restitution, cutoff, load and surface: the same bits as the tool friction_curve.

    eta [a/tau], gamma, cutoff [a/tau], rest_height [a], amplitude [a], frequency_ratio: numbers or arrays (k,); None is
    the model's. The points are all combinations, eta changing fastest, then gamma and so on.
    model: 'oscillator', 'hammer', or a Model; duration and transient: of the measurement and before it [tau].
    sweep: 'fresh' from random starts; 'up', 'down' from where the point before ended, along eta, which must ascend.
    With 'down' the drag velocity falls, and so do the rows.
    bath: a heat bath; or in place of it its numbers: temperature kT [m_tip a^2/tau^2], quality_factor (above 0: there
    is a bath), lateral_quality_factor, kicks_per_tau. seed: of the random starts and of the bath; None is the bath's,
    or 1.
    threads: 0 is one for each processor; no bit depends on it. progress(done, all) is called ten times a second.

    Returns a structured array, a row for each point: eta, gamma, cutoff, k_f, k_f_std_error [m_tip/tau],
    impacts_per_tau, mean_energy_loss [m_tip a^2/tau^2], mean_flight_time [tau], largest_lyapunov [1/tau],
    attractor (text), rest_height, amplitude, frequency_ratio, k_f_work, k_f_work_std_error [m_tip/tau].
    Plot k_f_work against eta: it is friction, from the work of the drag. k_f, from the energy lost in impacts, agrees
    with it without a bath alone.
    """
    chosen = _model(model)
    of_bath = dict(temperature=temperature, quality_factor=quality_factor,
                   lateral_quality_factor=lateral_quality_factor, kicks_per_tau=kicks_per_tau)
    if bath is None:
        bath = Bath(temperature, quality_factor, lateral_quality_factor, kicks_per_tau,
                    1 if seed is None else seed_of(seed))
    elif not isinstance(bath, Bath):
        raise ArgumentTypeError('bath', bath, 'must be a Bath')
    elif any(number(name, value) != getattr(Bath(), name) for name, value in of_bath.items()):
        raise ParameterError('bath', bath, 'is given beside temperature, quality factors or kicks_per_tau: give either')
    elif bath.stream != 0:
        raise ParameterError('bath.stream', bath.stream, 'must be 0: every point has a stream of its own')
    seed = bath.seed if seed is None else seed_of(seed)
    axes = _axes(chosen, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio)
    if not isinstance(sweep, str):
        raise ArgumentTypeError('sweep', sweep, 'must be fresh, up or down')
    if progress is not None and not callable(progress):
        raise ArgumentTypeError('progress', progress, 'must be a function of two numbers')
    return _structured(*_afm.friction_curve(axes, chosen.kind, sweep, number('duration', duration),
                                            number('transient', transient), bath, seed, thread_count(threads),
                                            progress))


def _laboratory(name):
    """The function of the library, where it was built with the laboratory."""
    if not hasattr(_afm, name):
        raise NotImplementedError('%s: this module was built without the laboratory (AFM_DYNAMICS=OFF)' % name)
    return getattr(_afm, name)


def attractors(eta: Axis = 3.4, *, gamma: Optional[Axis] = None, cutoff: Optional[Axis] = None,
               rest_height: Optional[Axis] = None, amplitude: Optional[Axis] = None,
               frequency_ratio: Optional[Axis] = None, model: Union[str, Model] = 'oscillator',
               starts: Union[int, Sequence[Sequence[float]], np.ndarray] = 200, seed: int = 1,
               transient: float = 500.0, duration: float = 500.0, friction_duration: float = 1000.0,
               labels: bool = False, threads: int = 0):
    """What attractors there are, and from which starts.

    Points and models as of friction_curve(); transient, duration, friction_duration [tau]. Several points share the
    threads.
    starts: how many random ones at each point; or an array (n, 5) of phase, extension, y [a], u, w [a/tau].

    Returns a structured array, a row for each attractor: eta, gamma, cutoff, attractor (text), impacts and cells in a
    period (0: it does not repeat), k_f, k_f_std_error [m_tip/tau], lyapunov_1 to lyapunov_4 [1/tau], rotation_number
    (of a quasi-periodic one; nan where none is seen), contact_share, basin (share of the starts), basin_std_error, and
    a start that leads there: phase, extension, y [a], u, w [a/tau]. With labels=True (table, starts): a row of `starts`
    for each start at each point, in their order, with the fields point (0 for the first), attractor_row (in the table),
    and phase, extension, y, u, w. This is a map of the basins.
    """
    chosen = _model(model)
    axes = _axes(chosen, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio)
    _afm.check_point_count(float(np.prod([float(len(axis)) for axis in axes])))
    mesh = np.meshgrid(*reversed(axes), indexing='ij')  # eta changes fastest
    points = np.stack([axis.ravel() for axis in reversed(mesh)], axis=1)
    given = np.empty((0, 5)) if np.ndim(starts) == 0 else _rows_of_starts(starts)
    how_many = count('starts', starts, least=1) if np.ndim(starts) == 0 else len(given)
    columns, rows, names, where = _laboratory('attractors')(
        points, chosen.kind, how_many, given, seed_of(seed), number('transient', transient),
        number('duration', duration), number('friction_duration', friction_duration), thread_count(threads))
    found = _structured(columns, rows, names, whole=('impacts', 'cells'))
    if not labels:
        return found
    return found, _structured(('point', 'attractor_row', 'phase', 'extension', 'y', 'u', 'w'), where,
                              whole=('point', 'attractor_row'))


def _rows_of_starts(starts):
    try:
        rows = np.array([tuple(row) for row in starts], float)
    except (TypeError, ValueError):
        rows = np.empty(0)
    if rows.ndim != 2 or rows.shape[1] != 5:
        raise ArgumentTypeError('starts', starts, 'must be a whole number, or rows of phase, extension, y, u, w')
    return rows


def periodic_orbits(eta: float = 3.4, *, model: Union[str, Model] = 'oscillator', max_length: int = 6,
                    trajectory: int = 200000, guesses: int = 3000, seed: int = 1) -> np.ndarray:
    """The periodic orbits of up to max_length impacts that a search finds, stable or not.

    trajectory: impacts of the run that guesses are taken from; guesses: of each of three kinds, for each length.

    Returns a structured array, a row for each orbit: length [impacts], cells, period [tau], k_f [m_tip/tau], residual,
    the first point just after an impact (phase, extension [a], u, w [a/tau]), multipliers (4 complex numbers, largest
    first).
    """
    columns, rows, _ = _laboratory('periodic_orbits')(
        _model(model), number('eta', eta), count('max_length', max_length), count('trajectory', trajectory),
        count('guesses', guesses), seed_of(seed))
    orbits = _structured(columns, rows, whole=('length', 'cells'))
    own = orbits.dtype.descr[:-8]  # behind them the multipliers' real and imaginary parts
    return orbits.view(own + [('multipliers', 'c16', 4)])


def lyapunov(eta: float = 3.4, *, model: Union[str, Model] = 'oscillator', phase: float = 0.25, extension: float = 0.0,
             y: float = 0.2, u: Optional[float] = None, w: float = 0.0, transient: float = 500.0,
             duration: float = 2000.0, most_events: int = 20000000, contact_tolerance: float = 1e-3):
    """The Lyapunov exponents [1/tau] of the orbit that a start leads to; see afm.Lyapunov.

    The start as of Tip; transient and duration: before and of the measurement [tau]; most_events: allowed to both
    together. The errors are of chance alone: where the tip comes to lie on the surface, as at eta = 5, the exponents
    depend on contact_tolerance by more. They are nan where the tip lands without any normal speed, as no derivative
    exists there.
    """
    return _laboratory('lyapunov')(
        _model(model), number('eta', eta), number('phase', phase), number('extension', extension), number('y', y), u,
        number('w', w), number('transient', transient), number('duration', duration),
        count('most_events', most_events, 1, 2 ** 64 - 1), number('contact_tolerance', contact_tolerance))


_INPUTS = ('eta', 'gamma', 'cutoff', 'phase', 'extension', 'u', 'w')
_RESULTS = ('dt', 'phase_next', 'extension_next', 'u_next', 'w_next', 'normal_speed', 'tangential_velocity',
            'energy_loss')


def next_impact(states: Optional[np.ndarray] = None, *, model: Union[str, Model] = 'oscillator',
                on_error: str = 'raise', threads: int = 0, **columns: Axis) -> np.ndarray:
    """The next impact of each state just after an impact: the same bits as the tool next_impact. Every bounce by
    itself.

    states: a structured array with the fields phase, extension [a], u, w [a/tau], and eta, gamma, cutoff where they are
    not given; or these as keywords, numbers or arrays that broadcast. gamma and cutoff default to the model's.
    on_error: 'raise', or 'nan' for rows that have no next impact, and for those with a fault in an argument.

    Returns a structured array of the broadcast shape: the seven inputs, then dt [tau], phase_next, extension_next [a],
    u_next, w_next (after the impact), normal_speed, tangential_velocity (before it) [a/tau],
    energy_loss [m_tip a^2/tau^2].
    """
    chosen = _model(model)
    given: Dict[str, Axis] = {'gamma': chosen.gamma, 'cutoff': chosen.cutoff}
    if states is not None:
        fields = getattr(getattr(states, 'dtype', None), 'names', None)
        if not fields:
            raise ArgumentTypeError('states', states, 'must be a structured array with the fields %s' %
                                    ', '.join(_INPUTS))
        given.update({name: states[name] for name in _INPUTS if name in fields})
    given.update(columns)
    wrong = sorted(set(given) - set(_INPUTS)) + sorted(set(_INPUTS) - set(given))
    if wrong:
        raise TypeError('next_impact() needs %s; wrong or missing: %s' % (', '.join(_INPUTS), ', '.join(wrong)))
    if on_error not in ('raise', 'nan'):
        raise ParameterError('on_error', on_error, 'must be raise or nan')
    inputs = np.broadcast_arrays(*(array(name, given[name]) for name in _INPUTS))
    shape = inputs[0].shape
    constants = [np.full(shape, x) for x in (chosen.rest_height, chosen.amplitude, chosen.frequency_ratio)]
    rows = np.stack([column.ravel() for column in list(inputs) + constants], axis=1)
    results = _afm.next_impact(rows, chosen.kind, on_error == 'raise', thread_count(threads))
    table = np.hstack([rows[:, :len(_INPUTS)], results.reshape(-1, len(_RESULTS))])
    return _structured(_INPUTS + _RESULTS, table).reshape(shape)

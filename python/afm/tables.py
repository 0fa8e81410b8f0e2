"""What the tools of these names compute, as structured arrays with the tools' columns."""
from typing import Callable, Dict, Optional, Union

import numpy as np

from . import _afm
from ._afm import Bath, Model
from .errors import ParameterError

Axis = Union[float, np.ndarray]
_NAME = 'U16'  # of an attractor


def _structured(columns, numbers, names, whole=()):
    """Numbers (n, m) under the names of the columns; a column `attractor` takes the names of attractors."""
    table = np.empty(len(numbers), [(c, _NAME if c == 'attractor' else 'i8' if c in whole else 'f8') for c in columns])
    values = iter(numbers.T)
    for column in columns:
        table[column] = names if column == 'attractor' else next(values)
    return table


def _axis(name, values):
    array = np.atleast_1d(np.asarray(values, float))
    if array.ndim != 1:
        raise ValueError('%s: must be a number or a one-dimensional array' % name)
    return array


def _axes(model, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio):
    """Those that are not given are the model's."""
    given = dict(eta=eta, gamma=model.gamma if gamma is None else gamma, cutoff=model.cutoff if cutoff is None else cutoff,
                 rest_height=model.rest_height if rest_height is None else rest_height,
                 amplitude=model.amplitude if amplitude is None else amplitude,
                 frequency_ratio=model.frequency_ratio if frequency_ratio is None else frequency_ratio)
    return [_axis(name, values) for name, values in given.items()]


def _model(model: Union[str, Model]) -> Model:
    return Model(kind=model) if isinstance(model, str) else model


def _count(name, value, least=0):
    if value != int(value) or value < least:
        raise ParameterError(name, value, 'must be a whole number, at least %d' % least)
    return int(value)


def friction_curve(eta: Axis, *, gamma: Optional[Axis] = None, cutoff: Optional[Axis] = None,
                   rest_height: Optional[Axis] = None, amplitude: Optional[Axis] = None,
                   frequency_ratio: Optional[Axis] = None, model: Union[str, Model] = 'oscillator',
                   duration: float = 10000.0, transient: float = 1000.0, sweep: str = 'fresh',
                   temperature: float = 0.0, quality_factor: float = 0.0, lateral_quality_factor: float = 0.0,
                   kicks_per_tau: float = Bath().kicks_per_tau, seed: int = 1, threads: int = 0,
                   progress: Optional[Callable[[int, int], None]] = None) -> np.ndarray:
    """K_f against drag velocity, restitution, cutoff, load and surface: the same bits as the tool friction_curve.

    eta [a/tau], gamma, cutoff [a/tau], rest_height [a], amplitude [a], frequency_ratio: numbers or arrays (k,); None is the
    model's. The points are all combinations, eta changing fastest, then gamma and so on.
    model: 'oscillator', 'hammer', or a Model; duration and transient: of the measurement and before it [tau].
    sweep: 'fresh' from random starts; 'up', 'down' from where the point before ended, along eta.
    temperature: kT [m a^2/tau^2]; quality_factor above 0 gives a heat bath.
    threads: 0 is one for each processor; no bit depends on it. progress(done, all) is called ten times a second.

    Returns a structured array, a row for each point: eta, gamma, cutoff, k_f, k_f_std_error [m_tip/tau], impacts_per_tau,
    mean_energy_loss [m a^2/tau^2], mean_flight_time [tau], largest_lyapunov [1/tau], attractor (text), rest_height,
    amplitude, frequency_ratio, k_f_work, k_f_work_std_error [m_tip/tau].
    """
    chosen = _model(model)
    seed = _count('seed', seed)
    bath = Bath(temperature, quality_factor, lateral_quality_factor, kicks_per_tau, seed)
    axes = _axes(chosen, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio)
    return _structured(*_afm.friction_curve(axes, chosen.kind, sweep, duration, transient, bath, seed,
                                            _count('threads', threads), progress))


def attractors(eta: Axis = 3.4, *, gamma: Optional[Axis] = None, cutoff: Optional[Axis] = None,
               rest_height: Optional[Axis] = None, amplitude: Optional[Axis] = None,
               frequency_ratio: Optional[Axis] = None, model: Union[str, Model] = 'oscillator', starts: int = 200,
               seed: int = 1, transient: float = 500.0, duration: float = 500.0, friction_duration: float = 1000.0,
               threads: int = 0) -> np.ndarray:
    """What attractors there are, found from so many random starts at each point.

    Points and models as of friction_curve(); transient, duration, friction_duration [tau]. Several points share the threads.

    Returns a structured array, a row for each attractor: eta, gamma, cutoff, attractor (text), impacts and cells in a period (0:
    it does not repeat), k_f, k_f_std_error [m_tip/tau], lyapunov_1 to lyapunov_4 [1/tau], rotation_number, contact_share, basin
    (share of the starts), basin_std_error, and a start that leads there: phase, extension, y [a], u, w [a/tau].
    """
    chosen = _model(model)
    axes = _axes(chosen, eta, gamma, cutoff, rest_height, amplitude, frequency_ratio)
    mesh = np.meshgrid(*reversed(axes), indexing='ij')  # eta changes fastest
    points = np.stack([axis.ravel() for axis in reversed(mesh)], axis=1)
    return _structured(*_afm.attractors(points, chosen.kind, starts, _count('seed', seed), transient, duration,
                                        friction_duration, _count('threads', threads)), whole=('impacts', 'cells'))


def periodic_orbits(eta: float = 3.4, *, model: Union[str, Model] = 'oscillator', max_length: int = 6,
                    trajectory: int = 200000, guesses: int = 3000, seed: int = 1) -> np.ndarray:
    """The periodic orbits of up to max_length impacts that a search finds, stable or not.

    trajectory: impacts of the run that guesses are taken from; guesses: of each of three kinds, for each length.

    Returns a structured array, a row for each orbit: length [impacts], cells, period [tau], k_f [m_tip/tau], residual, the first
    point just after an impact (phase, extension [a], u, w [a/tau]), multipliers (4 complex numbers, largest first).
    """
    columns, numbers, _ = _afm.periodic_orbits(_model(model), eta, max_length, trajectory, guesses, _count('seed', seed))
    count = len(columns) - 8  # behind them the multipliers' real and imaginary parts
    whole = ('length', 'cells')
    orbits = np.empty(len(numbers), [(c, 'i8' if c in whole else 'f8') for c in columns[:count]] + [('multipliers', 'c16', 4)])
    for column, values in zip(columns[:count], numbers.T):
        orbits[column] = values
    orbits['multipliers'] = np.ascontiguousarray(numbers[:, count:]).view('c16')
    return orbits


def lyapunov(eta: float = 3.4, *, model: Union[str, Model] = 'oscillator', phase: float = 0.25, extension: float = 0.0,
             y: float = 0.2, u: Optional[float] = None, w: float = 0.0, transient: float = 500.0, duration: float = 2000.0,
             most_events: int = 20000000, contact_tolerance: float = 1e-3):
    """The Lyapunov exponents [1/tau] of the orbit that a start leads to; see afm.Lyapunov.

    The start as of Tip; transient and duration: before and of the measurement [tau]; most_events: allowed to both together.
    """
    return _afm.lyapunov(_model(model), eta, phase, extension, y, u, w, transient, duration,
                         _count('most_events', most_events, 1), contact_tolerance)


_INPUTS = ('eta', 'gamma', 'cutoff', 'phase', 'extension', 'u', 'w')
_RESULTS = ('dt', 'phase_next', 'extension_next', 'u_next', 'w_next', 'normal_speed', 'tangential_velocity', 'energy_loss')


def next_impact(states: Optional[np.ndarray] = None, *, model: Union[str, Model] = 'oscillator', on_error: str = 'raise',
                threads: int = 0, **columns: Axis) -> np.ndarray:
    """The next impact of each state just after an impact: the same bits as the tool next_impact. Every bounce by itself.

    states: a structured array with the fields phase, extension [a], u, w [a/tau], and eta, gamma, cutoff where they are not
    given; or these as keywords, numbers or arrays that broadcast. gamma and cutoff default to the model's.
    on_error: 'raise', or 'nan' for rows that have no next impact.

    Returns a structured array of the broadcast shape: the seven inputs, then dt [tau], phase_next, extension_next [a], u_next,
    w_next (after the impact), normal_speed, tangential_velocity (before it) [a/tau], energy_loss [m a^2/tau^2].
    """
    chosen = _model(model)
    given: Dict[str, Axis] = {'gamma': chosen.gamma, 'cutoff': chosen.cutoff}
    if states is not None:
        given.update({name: states[name] for name in _INPUTS if name in states.dtype.names})
    given.update(columns)
    wrong = sorted(set(given) - set(_INPUTS)) + sorted(set(_INPUTS) - set(given))
    if wrong:
        raise TypeError('next_impact() needs %s; wrong or missing: %s' % (', '.join(_INPUTS), ', '.join(wrong)))
    if on_error not in ('raise', 'nan'):
        raise ValueError('on_error = %s: must be raise or nan' % on_error)
    inputs = np.broadcast_arrays(*(np.asarray(given[name], float) for name in _INPUTS))
    shape = inputs[0].shape
    constants = [np.full(shape, x) for x in (chosen.rest_height, chosen.amplitude, chosen.frequency_ratio)]
    rows = np.stack([column.ravel() for column in list(inputs) + constants], axis=1)
    results, fault = _afm.next_impact(rows, chosen.kind, _count('threads', threads))
    results = results.reshape(-1, len(_RESULTS))
    if fault is not None and on_error == 'raise':
        _afm.check_flight(rows[fault[0]], chosen.kind)
        raise ValueError('state %d: %s' % fault)
    table = np.empty(len(rows), [(name, 'f8') for name in _INPUTS + _RESULTS])
    for i, name in enumerate(_INPUTS):
        table[name] = rows[:, i]
    for i, name in enumerate(_RESULTS):
        table[name] = results[:, i]
    return table.reshape(shape)

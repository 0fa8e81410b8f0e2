"""Recordings of the emulator: their model and commands, and the run simulated again to the same bits."""
import os
from typing import Any, Dict, Iterator, List, Optional, Sequence, Union

import numpy as np

from ._afm import Emulator, Units, state_layout
from .run_log import ZERO, RunLog, time_of
from .values import Batch

_SI_MODEL = ('omega_v_rad_per_s', 'omega_h_rad_per_s', 'tip_mass_kg', 'lattice_spacing_m', 'surface_amplitude_m',
             'rest_height_m', 'restitution_gamma', 'cutoff_speed')
_BATH = ('temperature_k', 'quality_factor', 'lateral_quality_factor', 'kicks_per_tau')
Paths = Union[str, 'os.PathLike[str]', Sequence[Union[str, 'os.PathLike[str]']]]


class Recording:
    """One epoch of a recording.

    units, model: of its configuration; eta: drag velocity at its beginning [a/tau]; configuration: the message;
    commands: structured array (n,) of the drag velocities that took effect: tau, phase, eta [a/tau], drag_velocity [m/s];
    begin, end: model times between which the run is simulated; epochs: all that the bag holds.
    """

    def __init__(self, path: Paths, epoch: Optional[int] = None, namespace: Optional[str] = None) -> None:
        log = RunLog([path] if isinstance(path, (str, os.PathLike)) else path, epoch, namespace)
        self.epoch: int = log.epoch
        self.epochs: List[int] = log.epochs
        self.configuration: Any = log.configuration
        self._live: Dict[str, Any] = {name: getattr(log.configuration, name) for name in _SI_MODEL + _BATH}
        self.units = self._units(self._live)
        self.model = self.units.model
        self.eta: float = log.configuration.drag_velocity / self.units.velocity
        self._start = log.start
        self._applied = log.commands()
        self.begin = ZERO if log.start is None else time_of(log.start)
        self.end = max([self.begin] + [time_of(m) for m in log.frictions] + [time_of(m) for m in self._applied])
        self._impacts = log.impacts
        self.commands = np.array([(m.time.tau, m.time.phase, m.drag_velocity / self.units.velocity, m.drag_velocity)
                                  for m in self._applied if hasattr(m, 'drag_velocity')],
                                 [('tau', 'i8'), ('phase', 'f8'), ('eta', 'f8'), ('drag_velocity', 'f8')])

    @staticmethod
    def _units(live):
        return Units(**{name: live[name] for name in _SI_MODEL})

    def _bath(self, live):
        return self.units.bath(seed=self.configuration.seed, **{name: live[name] for name in _BATH})

    def _emulator(self, live):
        if self._start is not None:
            if self._start.layout != state_layout():
                raise ValueError('its checkpoint is of layout %d; this version reads %d' % (self._start.layout, state_layout()))
            live.update({name: getattr(self._start, name) for name in live if hasattr(self._start, name)})
            return Emulator.restored(np.array(self._start.state, np.uint64))
        c = self.configuration
        emulator = Emulator(self.model, self.eta, c.initial_phase, c.initial_extension, c.initial_height, c.initial_u,
                            c.initial_w, c.sample_period_tau, c.samples_per_batch, c.friction_window_tau, c.impact_budget,
                            c.contact_tolerance, self._bath(live))
        if c.model != 'auto':  # auto begins as the full model; the first drag velocity brings its level
            emulator.set_level(c.model, c.contact_tolerance)
        return emulator

    def _apply(self, emulator, command, live):
        if hasattr(command, 'drag_velocity'):
            emulator.set_level(command.model, command.contact_tolerance)
            emulator.drag(command.drag_velocity / self.units.velocity)
            return
        live.update({name: getattr(command, name) for name in live if hasattr(command, name)})
        model = self._units(live).model
        emulator.change(gamma=model.gamma, cutoff=model.cutoff, rest_height=model.rest_height, bath=self._bath(live),
                        sample_period=command.sample_period_tau, samples_per_batch=command.samples_per_batch,
                        friction_window=command.friction_window_tau)
        emulator.set_level(command.model, command.contact_tolerance)

    def stretches(self) -> Iterator[Batch]:
        """The run simulated again, a Batch from each command to the next, in natural units."""
        live = dict(self._live)
        emulator = self._emulator(live)
        for command in self._applied:
            yield emulator.run(time_of(command), command.first_impact)
            self._apply(emulator, command, live)
        yield emulator.run(self.end, self._impacts)

    def simulate(self) -> Batch:
        """The whole run simulated again, in natural units: times a factor of `units`, the bits of the recording."""
        parts = list(self.stretches())
        joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in ('vertical', 'lateral', 'impacts')}
        return parts[-1]._replace(begin=parts[0].begin, first_sample=parts[0].first_sample,
                                  first_sample_time=parts[0].first_sample_time, first_impact=parts[0].first_impact, **joined)


def from_bag(path: Paths, epoch: Optional[int] = None, namespace: Optional[str] = None) -> Recording:
    """A recording of the emulator. path: of its bag, or a list of the bags that it was split into, in order.

    epoch: None is the first in the bag; namespace: of the node, where a bag holds several.
    """
    return Recording(path, epoch, namespace)

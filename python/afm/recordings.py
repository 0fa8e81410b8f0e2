"""Recordings of the emulator: their model and commands, and the run simulated again to the same bits."""
from typing import Any, Dict, Iterator, List, Optional

import numpy as np

from ._afm import Emulator, Units, state_layout
from .values import Batch, ModelTime

_KINDS = ('AppliedDrag', 'AppliedParameters', 'Checkpoint', 'Configuration', 'Deflection', 'Friction', 'ImpactArray')
_SI_MODEL = ('omega_v_rad_per_s', 'omega_h_rad_per_s', 'tip_mass_kg', 'lattice_spacing_m', 'surface_amplitude_m',
             'rest_height_m', 'restitution_gamma', 'cutoff_speed')
_BATH = ('temperature_k', 'quality_factor', 'lateral_quality_factor', 'kicks_per_tau')
_ZERO = ModelTime(0, 0.0)


def _time(message):
    return ModelTime(message.time.tau, message.time.phase)


def _open(path):
    try:
        import rosbag
    except ImportError as fault:
        raise ImportError('from_bag() reads with rosbag (Debian: python3-rosbag; else source the setup.bash of ROS): %s' %
                          fault)
    return rosbag.Bag(str(path))


def _topics(bag, namespace):
    """Of each kind of message its topic, of the only emulator in the bag or the one with this namespace."""
    found = {}
    for topic, info in bag.get_type_and_topic_info().topics.items():
        package, kind = info.msg_type.split('/')
        if package == 'afm_emulator' and kind in _KINDS:
            found.setdefault(topic.rsplit('/', 1)[0], {})[kind] = topic
    if namespace is None and len(found) == 1:
        return next(iter(found.values()))
    if namespace not in found:
        raise ValueError('namespace = %s: the bag holds recordings of %s' % (namespace, ', '.join(sorted(found)) or 'nothing'))
    return found[namespace]


class _Log:
    """The messages of one epoch that its run is a function of, and where it ends."""

    def __init__(self, path, epoch, namespace):
        with _open(path) as bag:
            topics = _topics(bag, namespace)
            if 'Configuration' not in topics:
                raise ValueError('%s: no configuration of an emulator' % path)
            read = {kind: [m for _, m, _ in bag.read_messages(topics=[topics[kind]])] if kind in topics else []
                    for kind in ('AppliedDrag', 'AppliedParameters', 'Checkpoint', 'Configuration', 'Friction')}
            self.epochs = sorted({m.epoch for m in read['Configuration']})
            self.epoch = self.epochs[0] if epoch is None else epoch
            if self.epoch not in self.epochs:
                raise ValueError('epoch = %s: the bag holds %s' % (epoch, self.epochs))
            self.configuration, = [m for m in read['Configuration'] if m.epoch == self.epoch][:1]
            self.drags, self.changes, self.checkpoints, self.frictions = (
                [m for m in read[kind] if m.epoch == self.epoch]
                for kind in ('AppliedDrag', 'AppliedParameters', 'Checkpoint', 'Friction'))
            self.first_epoch = min(m.epoch for m in read['Friction']) if read['Friction'] else self.epoch
            self.read_batches(bag, topics)
        self.start = self.choose_start()

    def read_batches(self, bag, topics):
        def of(kind):
            return (m for _, m, _ in bag.read_messages(topics=topics.get(kind, '/')) if m.epoch == self.epoch)

        self.first_sample = next((m.first_sample for m in of('Deflection')), 0)
        numbers = [(m.first_index, m.first_index + len(m.impacts)) for m in of('ImpactArray')]
        self.first_impact, self.impacts = (numbers[0][0], numbers[-1][1]) if numbers else (0, 0)

    def choose_start(self):
        """The last checkpoint before the first batch; None where commands reach back to the beginning."""
        if self.epoch != self.first_epoch or not self.frictions:
            return None
        end = _time(self.frictions[0])
        before = [c for c in self.checkpoints if c.samples <= self.first_sample and c.impacts <= self.first_impact and
                  _time(c) < end]
        if not before or (_time(before[-1]) == _ZERO and self.drags and _time(self.drags[0]) == _ZERO):
            return None
        return before[-1]

    def commands(self):
        """Drag velocities and changes of parameters in the order in which they took effect."""
        drags, changes, before = self.drags, self.changes, 0
        if self.start is not None:
            before = self.start.drags
            drags = [m for m in drags if m.header.seq >= self.start.next_drag]
            changes = [m for m in changes if m.header.seq >= self.start.next_parameters]
        elif not drags or _time(drags[0]) != _ZERO:
            raise ValueError('the commands in the bag do not reach back to a beginning')
        merged, taken = [], 0
        for change in changes:
            count = change.first_command - before
            merged += drags[taken:count] + [change]
            taken = max(taken, count)
        return merged + drags[taken:]


class Recording:
    """One epoch of a recording.

    units, model: of its configuration; eta: drag velocity at its beginning [a/tau]; configuration: the message;
    commands: structured array (n,) of the drag velocities that took effect: tau, phase, eta [a/tau], drag_velocity [m/s];
    begin, end: model times between which the run is simulated; epochs: all that the bag holds.
    """

    def __init__(self, path: str, epoch: Optional[int] = None, namespace: Optional[str] = None) -> None:
        log = _Log(path, epoch, namespace)
        self.epoch: int = log.epoch
        self.epochs: List[int] = log.epochs
        self.configuration: Any = log.configuration
        self._live: Dict[str, Any] = {name: getattr(log.configuration, name) for name in _SI_MODEL + _BATH}
        self.units = self._units(self._live)
        self.model = self.units.model
        self.eta: float = log.configuration.drag_velocity / self.units.velocity
        self._start = log.start
        self._applied = log.commands()
        self.begin = _ZERO if log.start is None else _time(log.start)
        self.end = max([self.begin] + [_time(m) for m in log.frictions] + [_time(m) for m in self._applied])
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
            yield emulator.run(_time(command), command.first_impact)
            self._apply(emulator, command, live)
        yield emulator.run(self.end, self._impacts)

    def simulate(self) -> Batch:
        """The whole run simulated again, in natural units: times a factor of `units`, the bits of the recording."""
        parts = list(self.stretches())
        joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in ('vertical', 'lateral', 'impacts')}
        return parts[-1]._replace(begin=parts[0].begin, first_sample=parts[0].first_sample,
                                  first_sample_time=parts[0].first_sample_time, first_impact=parts[0].first_impact, **joined)


def from_bag(path: str, epoch: Optional[int] = None, namespace: Optional[str] = None) -> Recording:
    """A recording of the emulator. epoch: None is the first in the bag; namespace: of the node, where a bag holds several."""
    return Recording(path, epoch, namespace)

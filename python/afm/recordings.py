"""Recordings of the emulator: their model and commands, and the run simulated again to the same bits."""
import bisect
import contextlib
import hashlib
import os
import struct
import warnings
from collections import defaultdict
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ._afm import VERSION, Bath, Model, Run, Units, arithmetic_fingerprint
from .arguments import count
from .errors import ArgumentTypeError
from .values import Batch, ModelTime

_SI_MODEL = ('omega_v_rad_per_s', 'omega_h_rad_per_s', 'tip_mass_kg', 'lattice_spacing_m', 'surface_amplitude_m',
             'rest_height_m', 'restitution_gamma', 'cutoff_speed')
_BATH = ('temperature_k', 'quality_factor', 'lateral_quality_factor', 'kicks_per_tau')
_KINDS = ('Applied', 'Configuration', 'Deflection', 'EmulatorStatus', 'Friction', 'ImpactArray', 'Snapshot')
_DIGESTED = ('Deflection', 'ImpactArray')
_DEFLECTION = struct.Struct('<I16xQ32xI')  # epoch, index of the first, number of samples
_IMPACTS = struct.Struct('<IQI')
_LOSS = np.dtype({'names': ['energy_loss'], 'formats': ['<f8'], 'offsets': [40], 'itemsize': 53})  # of an Impact
_JUST_AFTER = 1e-15  # [tau] so little behind a time all its impacts are taken, and none is waited for that never comes
_MOST_WAITING = 100  # batches in the queues of the topics when a recorder is stopped
Paths = Union[str, 'os.PathLike[str]', Sequence[Union[str, 'os.PathLike[str]']]]


class _Digest(NamedTuple):
    """Of the samples or of the losses of a batch, which a long recording has too many of."""

    epoch: int
    first: int
    length: int
    values: bytes


def _digest_of(kind: str, data: bytes) -> _Digest:
    """From the bytes of a message of Deflection or ImpactArray."""
    at = 16 + int.from_bytes(data[12:16], 'little')  # the header ends in a text
    layout = _DEFLECTION if kind == 'Deflection' else _IMPACTS
    epoch, first, count = layout.unpack_from(data, at)
    at += layout.size
    if kind == 'Deflection':  # a number stands before the second list too
        lists = [np.frombuffer(data, '<f8', count, at + i * (4 + 8 * count)) for i in range(2)]
    else:
        lists = [np.frombuffer(data, _LOSS, count, at)['energy_loss']]
    return _Digest(epoch, first, count, _hash(lists))


def _hash(lists: Sequence[Any]) -> bytes:
    return hashlib.blake2b(b''.join(values.tobytes() for values in lists), digest_size=8).digest()


def _messages(path: Any) -> Iterator[Tuple[str, str, str, bytes, Any, Any]]:
    """Topic, name of the node, type, bytes, message (of samples and impacts a digest), and stamp in the bag."""
    try:
        import rosbag
    except ImportError as fault:
        raise ImportError('from_bag() reads with rosbag (Debian: python3-rosbag; else source the setup.bash of ROS): '
                          '%s' % fault)
    known: Dict[str, Any] = {}
    with contextlib.suppress(ImportError):  # else rosbag makes classes from the bag's definitions: they may be damaged
        from afm_emulator import msg
        known = {c._md5sum: c for c in (getattr(msg, kind) for kind in _KINDS)}
        rosbag.bag._message_types.update(known)
    kinds = ['afm_emulator/' + kind for kind in _KINDS]
    try:
        with rosbag.Bag(str(path)) as bag:
            # rosbag record repeats latched messages without the name of their node: it is that of its namespace
            named = {c.topic.rpartition('/')[0]: c.header['callerid'] for c in bag._get_connections()
                     if c.datatype in kinds and 'callerid' in c.header}
            for topic, raw, stamp, header in bag.read_messages(
                    raw=True, return_connection_header=True,
                    connection_filter=lambda _, datatype, *__: datatype in kinds):
                node = header.get('callerid', named.get(topic.rpartition('/')[0], b''))
                kind = raw[0].split('/')[1]
                if kind not in _DIGESTED:
                    message = raw[4]().deserialize(raw[1])
                elif not known or raw[2] in known:
                    message = _digest_of(kind, raw[1])
                else:  # of another version, which the snapshot names
                    message = None
                yield topic, node.decode() if isinstance(node, bytes) else node, kind, raw[1], message, stamp
    except rosbag.bag.ROSBagUnindexedException as fault:
        raise ValueError('%s: not closed: rosbag reindex recovers what is in it (take a copy while it is written)' %
                         path) from fault
    except Exception as fault:  # damaged bytes make rosbag raise whatever they lead to
        if getattr(fault, 'filename', None):
            raise
        raise ValueError('%s: cannot be read: %s' % (path, str(fault) or type(fault).__name__)) from fault


def _read(paths: Sequence[Any], namespace: Optional[str]) -> Tuple[Dict[str, Dict[int, Any]], bool]:
    """Of one emulator, by type: the messages by their numbers in their topic. And whether the node recorded them, which
    alone stamps configuration and command two nanoseconds and one before the snapshot with which a bag begins."""
    found: Any = defaultdict(lambda: defaultdict(dict))
    known: Dict[Tuple[str, str, int], Tuple[str, int]] = {}
    stamps: Any = defaultdict(dict)  # of the first messages
    clashes: Dict[str, str] = {}
    for path in paths:
        nothing = True
        for topic, node, kind, data, message, stamp in _messages(path):
            nothing = False
            stamps[node][kind] = min(stamp, stamps[node].get(kind, stamp))
            seq, said = int.from_bytes(data[:4], 'little'), (topic, hash(data))  # latched ones are repeated
            if known.setdefault((node, kind, seq), said) != said:
                clashes[node] = '%s: of two emulators, or of one started twice, under the name "%s"' % (path, node)
            found[node][kind][seq] = message
        if nothing and len(paths) > 1:  # such as of rosbag record before the emulator began
            warnings.warn('%s: the bag holds no message of an emulator' % path, RuntimeWarning, stacklevel=4)
    if namespace is None and len(found) == 1:
        namespace = next(iter(found))
    if namespace not in found:
        raise ValueError('namespace = %s: the bag holds recordings of %s' % (namespace, ', '.join(sorted(found)))
                         if found else 'the bag holds no message of an emulator')
    if namespace in clashes:
        raise ValueError(clashes[namespace])
    first = stamps[namespace]
    by_node = 'Snapshot' in first and any(kind in first and (first['Snapshot'] - first[kind]).to_nsec() == behind
                                          for kind, behind in (('Configuration', 2), ('Applied', 1)))
    return {kind: dict(sorted(found[namespace][kind].items())) for kind in _KINDS}, by_node


def _model_time(message: Any) -> ModelTime:
    """Comparable: rosbag makes a class of its own for the ModelTime of every type of message, and unlike classes are
    unequal."""
    return ModelTime(message.tau, message.phase)


def _tau_between(begin: ModelTime, end: ModelTime) -> float:
    return end.tau - begin.tau + (end.phase - begin.phase)


def _of_epoch(kind: str, messages: Dict[int, Any], epoch: int) -> List[Any]:
    """Without a gap, up to the next epoch."""
    numbers = [seq for seq, m in messages.items() if m.epoch == epoch]
    after = [seq for seq in messages if numbers and seq > numbers[-1]][:1]
    if numbers and (numbers + after)[-1] - numbers[0] >= len(numbers + after):
        raise ValueError('messages of %s are missing in epoch %d' % (kind, epoch))
    return [messages[seq] for seq in numbers]


class Recording:
    """One epoch of a recording.

    configuration: the message; units: of this configuration;
    model, bath, contact_tolerance, eta [a/tau]: at the beginning, as Tip and Run take them;
    commands: structured array (n,) with the drag velocity at the beginning and after each command: tau, phase, eta
    [a/tau], drag_velocity [m/s];
    begin, end: model times between which the run is simulated;
    epochs: the epochs that the bag holds messages of.
    A ValueError names what is missing, if the run cannot be simulated without it.
    """

    def __init__(self, path: Paths, epoch: Optional[int] = None, namespace: Optional[str] = None) -> None:
        paths = [path] if isinstance(path, (str, os.PathLike)) else path
        are_paths = isinstance(paths, (list, tuple)) and all(isinstance(p, (str, os.PathLike)) for p in paths)
        if not are_paths or not paths:
            raise ArgumentTypeError('path', path, 'must be the path of a bag, or a list of paths')
        read, by_node = _read(paths, namespace)
        self._check_version(next(iter(read['Configuration'].values()), None))
        for kind, why in (('Snapshot', 'the state at its beginning'), ('Applied', 'what took effect'),
                          ('Friction', 'the end of the run')):
            if not read[kind]:
                raise ValueError('the bag holds no message of %s: %s is not known' % (kind, why))
        last = max(read['Friction'])
        for kind in _DIGESTED:  # where the node is killed, a bag ends within a batch
            if max(read[kind], default=0) > last + (1 if by_node else _MOST_WAITING):
                raise ValueError('messages of Friction are missing at the end')
            if max(read[kind], default=0) > last:
                warnings.warn('the run ends with its last message of Friction: %d batches of %s are behind it' %
                              (max(read[kind]) - last, kind), RuntimeWarning, stacklevel=3)
        self._check_ends(read, by_node)
        begun = sorted({m.epoch for m in read['Snapshot'].values()})
        with_batches = {m.epoch for m in read['Friction'].values()}
        self.epochs: List[int] = sorted({*begun, *with_batches})
        if epoch is None and min(with_batches) < begun[0]:
            raise ValueError('the bag begins before its first snapshot: the state there is not known; epoch = %d is '
                             'whole' % begun[0])
        first = next((e for e in begun if e in with_batches), begun[0])
        self.epoch: int = first if epoch is None else count('epoch', epoch)
        if self.epoch not in self.epochs:
            raise ValueError('epoch = %s: the bag holds %s' % (epoch, self.epochs))
        if self.epoch not in begun:
            raise ValueError('epoch = %s: the snapshot is missing with which it begins' % epoch)
        self._snapshots, frictions = (_of_epoch(kind, read[kind], self.epoch) for kind in ('Snapshot', 'Friction'))
        start = self._snapshots[0]
        self.configuration: Any = start.configuration
        self._check_version(start.configuration)
        self.units = self._units(start.configuration)
        self.model, at_begin = self._in_force(start.applied)
        self.eta: float = at_begin['eta']
        self.bath: Bath = at_begin['bath']
        self.contact_tolerance: float = at_begin['contact_tolerance']
        self.begin = _model_time(start.time)
        if not frictions:
            raise ValueError('the bag holds no message of Friction in epoch %d: the end of the run is not known' %
                             self.epoch)
        self._last = frictions[-1]
        self.end = _model_time(self._last.time)
        if _model_time(frictions[0].begin) < self.begin and self.begin > (0, 0.0):
            raise ValueError('the bag begins before its first snapshot: the state there is not known')
        self._applied = [m for m in read['Applied'].values() if m.epoch == self.epoch
                         and m.number > start.applied.number]
        numbers = [start.applied.number] + [m.number for m in self._applied]
        follow = all(after == before + 1 for before, after in zip(numbers, numbers[1:]))
        if not follow or numbers[-1] < self._snapshots[-1].applied.number:
            raise ValueError('messages of Applied are missing: a command is not known')
        self._check_batches(frictions)
        # an epoch may begin with an event: its batch of no length comes before the first snapshot
        place = self.begin, start.next_impact
        compared = [f.header.seq for f in frictions if (_model_time(f.begin), f.first_impact) >= place]
        self._digests = {kind: {seq: m for seq, m in read[kind].items()
                                if m and m.epoch == self.epoch and compared and compared[0] <= seq <= last}
                         for kind in _DIGESTED}
        if any(seq > self._last.header.seq for digests in self._digests.values() for seq in digests):
            raise ValueError('messages of Friction are missing at the end of epoch %d' % self.epoch)
        self.commands = np.array([(m.time.tau, m.time.phase, m.drag_velocity / self.units.velocity, m.drag_velocity)
                                  for m in [start.applied] + self._applied],
                                 [('tau', 'i8'), ('phase', 'f8'), ('eta', 'f8'), ('drag_velocity', 'f8')])

    @staticmethod
    def _check_version(configuration: Any) -> None:
        """Of 0.1.0 too, whose bags have no snapshot."""
        if configuration is None:
            return
        made_by, here = ('version %s with the arithmetic %s' % pair for pair in (
            (configuration.version, configuration.arithmetic_digest), (VERSION, arithmetic_fingerprint())))
        if made_by != here:
            raise ValueError('the bag was made by %s; this is %s' % (made_by, here))

    @staticmethod
    def _check_ends(read: Dict[str, Dict[int, Any]], by_node: bool) -> None:
        """The node publishes a snapshot before the first batch, and whatever tells a model time after the batch up to
        which it tells."""
        frictions, snapshot = list(read['Friction'].values()), next(iter(read['Snapshot'].values()))
        first, last = frictions[0], frictions[-1]
        if by_node and snapshot.epoch == first.epoch and _model_time(snapshot.time) < _model_time(first.begin):
            raise ValueError('messages of Friction are missing at the beginning, as the first snapshot says')
        applied = list(read['Applied'].values())[-1]
        whole = max(applied.samples_per_batch * applied.sample_period_tau,
                    _tau_between(_model_time(last.begin), _model_time(last.time)))
        for kind in ('EmulatorStatus', 'Applied', 'Snapshot'):
            for m in list(read[kind].values())[-1:]:
                behind = _model_time(last.time) if m.epoch == last.epoch else ModelTime(0, 0.0)
                waiting = 0.0 if by_node else (_MOST_WAITING + 0.5) * whole
                if m.epoch >= last.epoch and _tau_between(behind, _model_time(m.time)) > waiting:
                    raise ValueError('messages of Friction are missing at the end, as the last message of %s says' %
                                     kind)

    def _check_batches(self, frictions: List[Any]) -> None:
        """That each goes on where the last one ends, no further than it may, with the drag velocity in force."""
        in_force, end = [self._snapshots[0].applied] + self._applied, _model_time(frictions[0].begin)
        places = [(_model_time(m.time), m.first_impact) for m in self._applied]
        for f in frictions:
            begin = _model_time(f.begin)
            applied = in_force[bisect.bisect(places, (begin, f.first_impact))]
            if f.drag_velocity != applied.drag_velocity:
                raise ValueError('messages of Applied are missing: batch %d has another drag velocity' % f.header.seq)
            length = _tau_between(begin, _model_time(f.time))
            most = applied.samples_per_batch * applied.sample_period_tau + 1e-6  # [tau]: phases are below 1
            if begin != end or not 0 <= length <= most or f.impact_limit > self.configuration.impact_budget:
                raise ValueError('batch %d does not begin or end where it can: messages are damaged' % f.header.seq)
            end = _model_time(f.time)

    def _units(self, live: Any) -> Units:
        return Units(**{name: getattr(live if hasattr(live, name) else self.configuration, name) for name in _SI_MODEL})

    def _in_force(self, applied: Any) -> Tuple[Model, Dict[str, Any]]:
        """The model, and the other settings as Run.apply() takes them."""
        si = self._units(applied).model
        model = Model(si.gamma, si.cutoff, si.rest_height, si.amplitude, si.frequency_ratio, applied.model)
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of a temperature without damping: the node has said so
            bath: Bath = self.units.bath(seed=self.configuration.seed,
                                         **{name: getattr(applied, name) for name in _BATH})
        return model, dict(eta=applied.drag_velocity / self.units.velocity, bath=bath,
                           contact_tolerance=applied.contact_tolerance, friction_window=applied.friction_window_tau,
                           sample_period=applied.sample_period_tau, samples_per_batch=applied.samples_per_batch)

    def _run_from(self, snapshot: Any) -> Run:
        c = self.configuration
        model, live = self._in_force(snapshot.applied)
        state = {name: getattr(snapshot, name) for name in snapshot.__slots__
                 if name not in ('header', 'epoch', 'configuration', 'applied')}
        state = {name: _model_time(v) if hasattr(v, 'tau') else v for name, v in state.items()}
        return Run.from_snapshot(dict(
            state, model=model, initial_phase=c.initial_phase, initial_extension=c.initial_extension,
            initial_y=c.initial_height, initial_u=c.initial_u, initial_w=c.initial_w, impact_budget=c.impact_budget,
            **live))

    def _parts(self) -> Iterator[Batch]:
        """The run from one command or snapshot to the next."""
        def run_to(end: ModelTime, impacts: int) -> Iterator[Batch]:
            if run.now < end and run.impacts < impacts:  # an event that is due there too may come after the command
                yield run.advance(end, impacts=impacts - run.impacts)
            if run.now < end:
                yield run.advance(end)
            while run.now == end and run.impacts < impacts:  # of those at this very time
                yield run.advance(end.after(_JUST_AFTER), impacts=impacts - run.impacts)

        run = self._run_from(self._snapshots[0])
        marks = [(m.number, 0, m) for m in self._applied]
        marks += [(m.applied.number, 1 + i, m) for i, m in enumerate(self._snapshots[1:])]
        last = self._last
        begin = _model_time(last.begin), last.first_impact
        for _, is_snapshot, m in sorted(marks, key=lambda mark: mark[:2]):
            place = _model_time(m.time), m.next_impact if is_snapshot else m.first_impact
            if place > begin:  # it comes after the last batch
                break
            yield from run_to(*place)
            if is_snapshot:
                try:
                    run.snapshot()
                except ValueError:  # an event that is due comes first
                    yield run.advance(run.now)
                    run.snapshot()
            else:
                model, live = self._in_force(m)
                run.apply(gamma=model.gamma, cutoff=model.cutoff, rest_height=model.rest_height, kind=model.kind,
                          **live)
        yield from run_to(_model_time(last.time), last.first_impact + last.impact_limit)
        if begin[0] == _model_time(last.time) and last.impact_limit == 0:  # a batch of no length: what is due then
            yield run.advance(run.now)

    def simulate(self) -> Batch:
        """The whole run simulated again, in natural units: times a factor of `units`, the bits of the recording."""
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of the rate of kicks: the node has said so
            parts = list(self._parts())
        for name, unit in (('energy_loss', self.units.energy), ('impact_count', 1), ('window_force', self.units.force),
                           ('mean_normal_force', self.units.force)):
            if not np.array_equal(parts[-1].friction[name] * unit, getattr(self._last, name), equal_nan=True):
                self._refuse('the %s at its end' % name)
        joined = {name: np.concatenate([getattr(part, name) for part in parts])
                  for name in ('vertical', 'lateral', 'impacts')}
        run = parts[-1]._replace(begin=parts[0].begin, first_sample=parts[0].first_sample,
                                 first_sample_time=parts[0].first_sample_time, first_impact=parts[0].first_impact,
                                 holder=parts[0].holder, **joined)
        self._compare('Deflection', run.first_sample, [run.vertical, run.lateral], self.units.length)
        self._compare('ImpactArray', run.first_impact, [run.impacts['energy_loss']], self.units.energy)
        return run

    def _compare(self, kind: str, first: int, simulated: List[Any], unit: float) -> None:
        """Batch by batch, with what the bag holds."""
        for seq, m in self._digests[kind].items():
            begin, end = m.first - first, m.first - first + m.length
            is_there = 0 <= begin <= end <= len(simulated[0])
            if not is_there or m.values != _hash([v[begin:end] * unit for v in simulated]):
                self._refuse('message %d of %s' % (seq, kind))

    @staticmethod
    def _refuse(by: str) -> None:
        raise ValueError('the run is not as recorded, by %s: messages of Applied or Snapshot are missing, or the bag '
                         'is damaged' % by)


def from_bag(path: Paths, epoch: Optional[int] = None, namespace: Optional[str] = None) -> Recording:
    """A recording of the emulator. path: of its bag, or a list of the bags that it was split into.

    epoch: None is the first in the bag that advanced; namespace: the name of the node, where a bag holds several.
    """
    return Recording(path, epoch, namespace)

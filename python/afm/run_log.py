"""What the run in a recording is a function of: its configuration and commands, read from its bags."""
import contextlib

from .values import ModelTime

_KINDS = ('AppliedDrag', 'AppliedParameters', 'Checkpoint', 'Configuration', 'Deflection', 'Friction', 'ImpactArray',
          'Recording')
_REPEATED = ('AppliedDrag', 'AppliedParameters', 'Checkpoint')  # by every part of a split recording
ZERO = ModelTime(0, 0.0)


def time_of(message):
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


def _follows(last, first):
    """Whether a bag with this first mark of the recorder goes on where one with this last mark ends."""
    return last.kind == last.CONTINUED and (first.name, first.part) == (last.name, last.part + 1)


class _Bags:
    """The bags of one recording, in order, read as one."""

    def __init__(self, bags, namespace):
        if not bags:
            raise ValueError('path: names no bag')
        self.bags, self.topics = bags, _topics(bags[0], namespace)
        if 'Configuration' not in self.topics:
            raise ValueError('%s: no configuration of an emulator' % bags[0].filename)
        marks = [list(self.read_bag(bag, 'Recording')) for bag in bags]
        for bag, before, after in zip(bags[1:], marks, marks[1:]):
            if not (before and after and _follows(before[-1], after[0])):
                raise ValueError('%s does not go on where the bag before it ends: give the bags of one recording, in order' %
                                 bag.filename)

    def read_bag(self, bag, kind):
        return (m for _, m, _ in bag.read_messages(topics=self.topics.get(kind, '/')))

    def read(self, kind):
        """Each message once."""
        messages = (m for bag in self.bags for m in self.read_bag(bag, kind))
        return {(m.epoch, m.header.seq): m for m in messages}.values() if kind in _REPEATED else messages


class RunLog:
    """The messages of one epoch that its run is a function of, and where it ends."""

    def __init__(self, paths, epoch, namespace):
        with contextlib.ExitStack() as stack:
            bags = _Bags([stack.enter_context(_open(path)) for path in paths], namespace)
            read = {kind: list(bags.read(kind))
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
            self.read_batches(bags)
        self.start = self.choose_start()

    def read_batches(self, bags):
        def of(kind):
            return (m for m in bags.read(kind) if m.epoch == self.epoch)

        self.first_sample = next((m.first_sample for m in of('Deflection')), 0)
        numbers = [(m.first_index, m.first_index + len(m.impacts)) for m in of('ImpactArray')]
        self.first_impact, self.impacts = (numbers[0][0], numbers[-1][1]) if numbers else (0, 0)

    def choose_start(self):
        """The last checkpoint before the first batch; None where commands reach back to the beginning."""
        if self.epoch != self.first_epoch or not self.frictions:
            return None
        end = time_of(self.frictions[0])
        before = [c for c in self.checkpoints if c.samples <= self.first_sample and c.impacts <= self.first_impact and
                  time_of(c) < end]
        if not before or (time_of(before[-1]) == ZERO and self.drags and time_of(self.drags[0]) == ZERO):
            return None
        return before[-1]

    def commands(self):
        """Drag velocities and changes of parameters in the order in which they took effect."""
        drags, changes, before = self.drags, self.changes, 0
        if self.start is not None:
            before = self.start.drags
            drags = [m for m in drags if m.header.seq >= self.start.next_drag]
            changes = [m for m in changes if m.header.seq >= self.start.next_parameters]
        elif not drags or time_of(drags[0]) != ZERO:
            raise ValueError('the commands in the bag do not reach back to a beginning')
        merged, taken = [], 0
        for change in changes:
            count = change.first_command - before
            merged += drags[taken:count] + [change]
            taken = max(taken, count)
        return merged + drags[taken:]

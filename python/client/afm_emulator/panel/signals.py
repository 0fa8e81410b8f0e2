"""Signals as an instrument shows them. Lengths are in cells (a), times in tau, unless a name says otherwise."""
import collections

import numpy as np

# middle of the rising flank, for a tip that moves to the right: a crest is at 0, a valley at 0.5
TRIGGER_PHASE = 0.75
TRIGGER_SEARCH = 16.0   # tau: a motion with a period up to this stands still
RESTS = 0.002           # cells above the surface: a sample closer than that is of a tip in contact, or about to be
BOUNCE = 0              # kind of an impact: the others are of chatter and contact (msg/Impact.msg)
FINE_SAMPLES = 3000     # up to so many samples a signal is drawn in full
FINE_STEPS = 3          # points drawn per interval between samples then


NOTHING = np.empty((2, 0))


def newest(table, columns, capacity):
    return np.concatenate([table, columns], axis=1)[:, -capacity:]


def envelope(t, y, buckets):
    """At most 2 points per bucket, its least and its greatest, in their order: no peak is lost."""
    size = -(-len(y) // buckets) if buckets else len(y)
    if size <= 2:
        return t, y
    padded = np.full(-(-len(y) // size) * size, y[-1])
    padded[:len(y)] = y
    table = padded.reshape(-1, size)
    ends = np.sort(np.stack([table.argmin(axis=1), table.argmax(axis=1)], axis=1), axis=1)
    index = np.minimum((ends + size * np.arange(len(table))[:, None]).ravel(), len(y) - 1)
    return t[index], y[index]


def swing(t, y, omega, steps, is_free):
    """`steps` points per interval on the free oscillation of angular frequency omega through both of its ends; a
    straight line where the tip is not free, or the interval is too long to know the oscillation."""
    angle = omega * np.diff(t)[:, None]
    part = np.arange(steps) / steps
    with np.errstate(divide='ignore', invalid='ignore'):
        before, after = np.sin(angle * (1.0 - part)) / np.sin(angle), np.sin(angle * part) / np.sin(angle)
    known = (angle > 1e-6) & (angle < 2.8) & is_free[:, None]  # the sine of pi is 0
    before, after = np.where(known, before, 1.0 - part), np.where(known, after, part)
    return np.append((before * y[:-1, None] + after * y[1:, None]).ravel(), y[-1])


class Motion:
    """The tip's motion over a time, of all that is known: samples, and impacts, which lie on the surface. Between them
    it flies, unless it rests on the surface. Y is the deflection; the holder's height is added to it."""

    def __init__(self, samples, impacts, amplitude, omega_h, steps=FINE_STEPS):
        t, Y, X, xc, height = samples
        self.is_fine = len(t) <= FINE_SAMPLES
        if self.is_fine and len(t) > 1:
            at, phase, _, kind = impacts[:, (impacts[0] > t[0]) & (impacts[0] < t[-1])]
            rests = np.concatenate([Y + height - amplitude * np.cos(2 * np.pi * (xc + X)) < RESTS, kind != BOUNCE])
            holder, height_at = np.interp(at, t, xc), height[np.searchsorted(t, at) - 1]
            X_at = phase - holder
            X_at -= np.round(X_at - np.interp(at, t, X))  # in the cell in which the samples beside it are
            Y_at = amplitude * np.cos(2 * np.pi * phase) - height_at
            order = np.argsort(np.concatenate([t, at]), kind='stable')
            t, Y, X, xc, height = (np.concatenate(pair)[order] for pair in (
                (t, at), (Y, Y_at), (X, X_at), (xc, holder), (height, height_at)))
            is_free = ~(rests[order][:-1] | rests[order][1:])
            part = np.arange(steps) / steps
            Y, X = swing(t, Y, 2 * np.pi, steps, is_free), swing(t, X, omega_h, steps, is_free)
            t, xc = (np.append((v[:-1, None] + part * np.diff(v)[:, None]).ravel(), v[-1]) for v in (t, xc))
            height = np.append(np.repeat(height[:-1], steps), height[-1])
        self.t, self.Y, self.X, self.xc, self.height = t, Y, X, xc, height

    def trigger(self, span, direction):
        """Begin of a picture of that span: where the tip passes the middle of a rising flank; of the last passages the
        highest, so that a periodic motion stands still. None if it passes none."""
        first, last = np.searchsorted(self.t, (self.t[-1] - span - TRIGGER_SEARCH, self.t[-1] - span))
        t, Y = self.t[first:last], self.Y[first:last]
        x = direction * (self.xc + self.X)[first:last] - TRIGGER_PHASE
        flank = np.floor(x)
        i = np.flatnonzero(np.diff(flank) > 0)
        if not len(i):
            return None
        part = (flank[i + 1] - x[i]) / (x[i + 1] - x[i])
        begin = t[i] + part * (t[i + 1] - t[i])
        height = Y[i] + part * (Y[i + 1] - Y[i])
        # of equal heights the last: rounding and the line between two points make differences of a thousandth
        return begin[np.flatnonzero(height > height.max() - 1e-3 * np.ptp(Y))[-1]]

    def within(self, begin, end):
        a, b = np.searchsorted(self.t, (begin, end))
        return slice(max(a - 1, 0), b + 1)


class Recent:
    """The newest batches, of one epoch, without a gap. Only those that a picture needs become a table."""

    def __init__(self, capacity=1 << 19):
        self.capacity, self.batches, self.impacts = capacity, collections.deque(), collections.deque(maxlen=2000)
        self._heights = collections.deque(maxlen=2000)  # of the holder: ((epoch, first sample), height [m])
        self._count, self._next = 0, None

    def clear(self):
        self.batches.clear()
        self.impacts.clear()
        self._count, self._next = 0, None

    def add(self, batch, impacts):
        """A Deflection message whose arrays are of numpy, and its impacts: (epoch, table with the fields of Impact).
        Returns whether it goes on where the last batch ended."""
        goes_on = self._next == (batch.epoch, batch.first_sample)
        if not goes_on:
            self.clear()
        count = len(batch.vertical)
        self._next = batch.epoch, batch.first_sample + count
        if count:
            self.batches.append(batch)
            self._count += count
        while self.batches and self._count - len(self.batches[0].vertical) > self.capacity:
            self._count -= len(self.batches.popleft().vertical)
        self.impacts.extend(table for epoch, table in impacts if epoch == batch.epoch and len(table))
        return goes_on

    def change(self, applied):
        """What is in force from a sample on."""
        since, height = (applied.epoch, applied.first_sample), applied.rest_height_m
        if not self._heights or self._heights[-1][1] != height or since < self._heights[-1][0]:  # another emulator
            self._heights.append((since, height))

    def _height(self, batch):
        earlier = (height for since, height in reversed(self._heights) if since <= (batch.epoch, batch.first_sample))
        return next(earlier, self._heights[0][1] if self._heights else 0.0)

    def last(self, duration, spacing_m, tau_s):
        """Samples (t, Y, X, xc, height of the holder) and impacts (t, phase, energy lost, kind) of the last so many tau;
        t counts from a whole tau near them."""
        origin, tables = self.batches[-1].time.tau, []
        for batch in reversed(self.batches):
            seconds = batch.sample_period * np.arange(len(batch.vertical))
            t = (batch.time.tau - origin) + batch.time.phase + seconds / tau_s
            tables.append(np.stack([t, batch.vertical / spacing_m, batch.lateral / spacing_m,
                                    (batch.holder_position + batch.drag_velocity * seconds) / spacing_m,
                                    np.full(len(t), self._height(batch) / spacing_m)]))
            if t[0] < tables[0][0, -1] - duration:
                break
        samples = np.concatenate(tables[::-1], axis=1) if len(tables) > 1 else tables[0]
        begin = samples[0, -1] - duration
        events = [np.empty((4, 0))]
        for table in reversed(self.impacts):
            t = (table['tau'] - origin) + table['phase']
            events.append(np.stack([t, table['surface_phase'], table['energy_loss'], table['kind']]))
            if t[0] < begin:
                break
        impacts = np.concatenate(events[::-1], axis=1)
        return samples[:, np.searchsorted(samples[0], begin):], impacts[:, np.searchsorted(impacts[0], begin):]


class FrictionLoop:
    """Mean lateral force against the position of the holder: the last line in either direction."""
    PART_TAU = 8.0  # of the means

    def __init__(self, capacity=4000):
        self.capacity = capacity
        self.clear()

    def clear(self):
        self.lines, self.direction = {1: NOTHING, -1: NOTHING}, 0

    def add(self, batch, stiffness, tau_s):
        """A Deflection message whose arrays are of numpy; all in SI."""
        velocity, period, lateral = batch.drag_velocity, batch.sample_period, batch.lateral
        if velocity == 0.0 or len(lateral) == 0:
            return
        direction = 1 if velocity > 0.0 else -1
        if direction != self.direction:
            self.lines[direction] = NOTHING
        self.direction = direction
        size = min(max(1, round(self.PART_TAU * tau_s / period)), len(lateral))
        force = -stiffness * lateral[:len(lateral) // size * size].reshape(-1, size).mean(axis=1)
        if not lateral.any():  # of the hammer, whose spring along x is rigid
            force[:] = batch.lateral_impulse / (len(lateral) * period)
        middle = period * size * (np.arange(len(force)) + 0.5)
        columns = np.stack([batch.holder_position + velocity * middle, force])
        self.lines[direction] = newest(self.lines[direction], columns, self.capacity)


class Trail:
    """Friction at the drag speeds that were, and at the present one."""

    def __init__(self, capacity=3000):
        self.capacity = capacity
        self.clear()

    def clear(self):
        self.past, self.now = NOTHING, None  # (eta, K_f), and these and its error

    def end_run(self):
        if self.now is not None:
            self.past = newest(self.past, np.array(self.now[:2])[:, None], self.capacity)
        self.now = None

    def add(self, eta, k_f, error):
        if self.now is not None and self.now[0] != abs(eta):
            self.end_run()
        self.now = (abs(eta), k_f, error) if np.isfinite(k_f) else None


class Scale:
    """Bounds of an axis that grow at once, and shrink when they were far too wide for a while: so that a picture does
    not tremble."""

    def __init__(self, least_span, patience=30):
        """patience: updates until it shrinks."""
        self.least_span, self.patience = least_span, patience
        self.low, self.high, self._empty = 0.0, 0.0, 0

    def update(self, low, high):
        """Whether the bounds changed."""
        self._empty = self._empty + 1 if self.high - self.low > 2.5 * max(high - low, self.least_span) else 0
        shrinks = self._empty >= self.patience
        if self.low <= low and high <= self.high and not shrinks:
            return False
        if not shrinks:
            low, high = min(low, self.low), max(high, self.high)
        span = max(high - low, self.least_span)
        unit = 10.0 ** np.floor(np.log10(span))
        step = unit * next(f for f in (0.1, 0.2, 0.5, 1.0) if 10.0 * f * unit >= span)
        self.low, self.high, self._empty = step * np.floor(low / step), step * np.ceil(max(high, low + span) / step), 0
        return True

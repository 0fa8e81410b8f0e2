#!/usr/bin/python3
"""Draws a recorded run against model time: deflection, impacts, friction and drag speed. docs/recording.md says what is
in a bag; this is also an example of how to read it."""
import argparse
import contextlib
import os
import sys

try:
    import matplotlib
    matplotlib.use('Agg')
    import numpy as np
    import rosbag
    from afm_emulator import msg
    from afm_emulator.bags import in_order, read_raw, why_unreadable
    from afm_emulator.impacts import read_impacts
    from matplotlib import pyplot
except ImportError as missing:
    sys.exit('plot_run.py: %s; source devel/setup.bash, or let scripts/install_dependencies install what is missing '
             '(Debian: python3-rosbag, python3-matplotlib)' % missing)
except KeyboardInterrupt:
    sys.exit(130)

NAN = float('nan')
INCOMPLETE = 3  # exit code
MOST_POINTS = 4000  # of deflection; beyond it the range of every few samples is drawn
ZOOM_TAU = 6.0  # the end of the run, sample by sample
# Okabe and Ito's colours, which the colour-blind can tell apart
BLUE, ORANGE, GREEN, PINK = '#0072B2', '#D55E00', '#009E73', '#CC79A7'
KINDS = {0: ('impact', BLUE, 3), 1: ('chatter sequence', ORANGE, 14), 2: ('contact begins', GREEN, 12),
         3: ('contact ends', PINK, 12)}


class Run:
    """What is drawn, as arrays against model time in seconds since the first epoch of the recording began."""

    def __init__(self):
        self.close = []  # single samples of the last tau
        self.samples, self.impacts, self.friction, self.drag = [], [], [], []
        self.settings = []  # in force, one after another: those of the title
        self.epochs = {}  # where they begin
        self.configuration, self.unit, self.last = None, None, 0.0
        self.numbers, self.lost = {}, {}  # of each kind of message

    def count_lost(self, kind, number):
        lost = number - self.numbers.get(kind, number - 1) - 1
        self.numbers[kind] = number
        if lost > 0:
            self.lost[kind] = self.lost.get(kind, 0) + lost
            if kind == 'Deflection' and self.samples:
                self.samples.append(np.full((5, 1), NAN))  # a gap
                self.close.append(np.array([[self.close[-1][0, -1]], [NAN], [NAN]]))
            if kind == 'Friction':
                self.friction.append((self.last, NAN, NAN, NAN))

    def set_units(self, configuration):
        self.configuration = configuration
        self.unit = 2 * np.pi / configuration.omega_v_rad_per_s  # tau [s]
        self.speed = configuration.lattice_spacing_m / self.unit

    def moment(self, epoch, tau, phase):
        """[s] An epoch begins where the one before it ended."""
        return self.epochs.setdefault(epoch, self.last) + (tau + phase) * self.unit

    def seconds(self, message):
        moment = self.moment(message.epoch, message.time.tau, message.time.phase)
        self.last = max(self.last, moment)
        return moment

    def add_deflection(self, message, every):
        begin = self.seconds(message)
        values = np.array([message.vertical, message.lateral]) * 1e9
        times = begin + message.sample_period * np.arange(values.shape[1])
        if not len(times):
            return
        columns = max(1, round(len(times) / every))  # of one length: a short one would show less of the range
        edges = np.arange(columns) * len(times) // columns
        low, high = np.minimum.reduceat(values, edges, axis=1), np.maximum.reduceat(values, edges, axis=1)
        self.samples.append(np.vstack([times[edges], low, high]))
        self.close.append(np.vstack([times, values]))
        while self.close[0][0, -1] < times[-1] - ZOOM_TAU * self.unit:
            self.close.pop(0)

    def add_impacts(self, data):
        epoch, _, impacts = read_impacts(data)
        if len(impacts):
            times = self.moment(epoch, impacts['tau'], impacts['phase'])
            self.last = max(self.last, times[-1])
            self.impacts.append(np.column_stack([times, impacts['normal_speed'] * 1e6, impacts['kind']]))

    def add_friction(self, message):
        per_unit = message.k_f_work_natural / message.k_f_work if message.k_f_work else NAN
        by_impacts = NAN if message.heat_to_bath else message.window_k_f_natural  # with a bath it is not the friction
        self.friction.append((self.seconds(message), message.k_f_work_natural,
                              message.k_f_work_std_error * per_unit, by_impacts))

    def add_applied(self, message):
        moment = self.moment(message.epoch, message.time.tau, message.time.phase)
        self.drag.append((moment, message.drag_velocity * 1e6))
        self.settings.append(message)

    def title(self):
        """A value that changes by its least and its greatest."""
        ranges = []
        for name, unit, digits in (('restitution_gamma', 1.0, '%g'), ('cutoff_speed', 1e-6, '%.3g'),
                                   ('sample_rate_hz', 1e3, '%g')):
            values = [getattr(settings, name) / unit for settings in self.settings or [self.configuration]]
            ends = [digits % end for end in (min(values), max(values))]
            ranges.append(ends[0] if ends[0] == ends[1] else ' to '.join(ends))
        return '$\\gamma$ = %s, $v_c$ = %s $\\mu$m/s, %s kHz' % tuple(ranges)


@contextlib.contextmanager
def open_bag(path):
    try:
        with rosbag.Bag(path) as bag:
            yield bag
    except Exception as fault:
        sys.exit('plot_run.py: %s: %s' % (path, why_unreadable(fault)))


def count_samples(paths, node):
    """From the first batch of every bag, about."""
    count = 0
    for path in paths:
        with open_bag(path) as bag:
            topics = bag.get_type_and_topic_info().topics
            for m in read_raw(bag, ['Deflection']):
                if node in (None, m.node):
                    count += topics[m.topic].message_count * len(m.of_type().deserialize(m.data).vertical)
                    break
    return count


def check_version(m):
    if m.md5sum != getattr(msg, m.kind)._md5sum:
        raise ValueError('%s is of another version of afm_emulator/%s' % (m.topic, m.kind))


def find_configuration(paths, node):
    """The first one, for the units of all: also of what was before it, as in a bag that is cut."""
    for path in paths:
        with open_bag(path) as bag:
            for m in read_raw(bag, ['Configuration', 'Snapshot']):
                if node in (None, m.node):
                    check_version(m)
                    message = m.of_type().deserialize(m.data)
                    return message if m.kind == 'Configuration' else message.configuration
    return None


def read(paths, node):
    run = Run()
    configuration = find_configuration(paths, node)
    if configuration is not None:
        run.set_units(configuration)
    every = max(1, 2 * count_samples(paths, node) // MOST_POINTS)
    known, sources, others = {}, {}, set()
    add = {'Configuration': lambda m: run.epochs.setdefault(m.epoch, run.last),
           'Deflection': lambda m: run.add_deflection(m, every), 'ImpactArray': run.add_impacts,
           'Friction': run.add_friction, 'Applied': run.add_applied}
    for path in paths:
        with open_bag(path) as bag:
            for m in read_raw(bag, add):
                if node not in (None, m.node):
                    others.add(m.node)
                    continue
                if sources.setdefault(m.kind, (m.node, m.topic)) != (m.node, m.topic):
                    raise ValueError('%s by %s and %s by %s: choose one emulator by --node' % (
                        sources[m.kind][1], sources[m.kind][0] or 'nobody', m.topic, m.node or 'nobody'))
                number, said = (m.kind, int.from_bytes(m.data[:4], 'little')), hash(m.data)
                if known.get(number, said) != said:
                    raise ValueError('%s was started again: this is another run' % (m.node or 'the emulator'))
                is_new = number not in known  # the bags of a split recording repeat what was before
                if is_new:
                    run.count_lost(*number)
                known[number] = said
                check_version(m)
                if is_new and run.configuration is not None:
                    add[m.kind](m.data if m.kind == 'ImpactArray' else m.of_type().deserialize(m.data))
    if run.configuration is None or not run.samples:
        named = '' if node is None else ' %s, but of %s' % (node, ' and '.join(sorted(others)) or 'no other')
        sys.exit('plot_run.py: %s: no run of the emulator%s in it: it holds no message of %s' %
                 (' '.join(paths), named, 'Deflection' if run.configuration else 'Configuration'))
    return run


def put_legend(axes, **options):
    """Above, where it hides nothing."""
    if not axes.get_legend_handles_labels()[0]:
        return
    axes.legend(loc='lower right', bbox_to_anchor=(1, 1), ncol=4, frameon=False, borderaxespad=0.1, **options)


def draw_deflection(axes, run):
    columns = np.hstack(run.samples)
    if columns.shape[1] > MOST_POINTS:  # of many short batches, each of which has one
        edges = np.arange(MOST_POINTS) * columns.shape[1] // MOST_POINTS
        columns = np.vstack([columns[0, edges], np.minimum.reduceat(columns[1:3], edges, axis=1),
                             np.maximum.reduceat(columns[3:], edges, axis=1)])
    times, *ranges = columns
    times = np.where(np.isnan(times), np.fmax.accumulate(times), times)
    for name, low, high, colour in (('vertical', ranges[0], ranges[2], BLUE),
                                    ('lateral', ranges[1], ranges[3], ORANGE)):
        axes.fill_between(times, low, high, lw=0.8, color=colour, alpha=0.6, label=name + ', range')
    axes.set_ylabel('deflection [nm]')
    put_legend(axes)
    return times


def draw_zoom(axes, run):
    """The last tau, in tau."""
    times, vertical, lateral = np.hstack(run.close)
    times = (times - times[-1]) / run.unit
    shown = times >= -ZOOM_TAU
    for name, values, colour in (('vertical', vertical, BLUE), ('lateral', lateral, ORANGE)):
        axes.plot(times[shown], values[shown], lw=0.8, marker='.', ms=3, c=colour, label=name)
    axes.set(ylabel='deflection [nm]', xlabel='model time before the end [$\\tau$]')
    axes.grid(alpha=0.3)
    put_legend(axes)


def draw_impacts(axes, run):
    impacts = np.vstack(run.impacts) if run.impacts else np.zeros((0, 3))
    for kind, (name, colour, size) in KINDS.items():
        chosen = impacts[(impacts[:, 2] == kind) & (impacts[:, 1] > 0)]
        if len(chosen):
            axes.scatter(chosen[:, 0], chosen[:, 1], s=size, c=colour, label=name, lw=0, rasterized=True)
    for kind, height in ((2, 0.03), (3, 0.07)):  # without a speed: along the lower edge
        name, colour, _ = KINDS[kind]
        chosen = impacts[impacts[:, 2] == kind, 0]
        if len(chosen):
            axes.scatter(chosen, np.full(len(chosen), height), s=30, c=colour, marker='|', label=name,
                         transform=axes.get_xaxis_transform(), rasterized=True)
    axes.set(yscale='log', ylabel='normal speed of\nimpacts [$\\mu$m/s]')
    put_legend(axes, markerscale=2)


def draw_friction(axes, run):
    friction = np.array(run.friction).reshape(-1, 4)
    times, mean, error, window = friction.T
    if np.isfinite(window).any():
        axes.plot(times, window, lw=0.7, c='0.6', label='by impacts, in a sliding window')
    axes.plot(times, mean, lw=1.2, c=BLUE, label='by the work of the drag, since the last command')
    axes.fill_between(times, mean - error, mean + error, alpha=0.3, lw=0, color=BLUE)
    positive = np.array([value for value in np.hstack([mean, window]) if value > 0])
    often_negative = np.sum(mean < 0) > 0.1 * len(mean)  # as by the work of a heated tip: it is shown too
    if len(positive) and positive.max() > 10 * positive.min() and not often_negative:
        axes.set_yscale('log')
    axes.set_ylabel('$K_f$ [$m_{tip}/\\tau$]')
    put_legend(axes)


def draw_drag(axes, run):
    drag = np.array(run.drag + [(run.last, run.drag[-1][1])]) if run.drag else np.zeros((0, 2))
    axes.step(drag[:, 0], drag[:, 1], where='post', color=BLUE)
    axes.set(ylabel='drag speed [$\\mu$m/s]', xlabel='model time [s]')
    eta = axes.secondary_yaxis('right', functions=(lambda v: v * 1e-6 / run.speed, lambda e: e * run.speed * 1e6))
    eta.set_ylabel('$\\eta$ [a/$\\tau$]')


def draw(run, paths):
    pyplot.rcParams.update({'font.size': 10, 'legend.fontsize': 9, 'xtick.labelsize': 9, 'ytick.labelsize': 9})
    figure = pyplot.figure(figsize=(9.375, 10.4), constrained_layout=True)  # 900 pixels of a page, at 96 an inch
    grid = figure.add_gridspec(5, 1)
    rows = [figure.add_subplot(grid[0])]
    rows += [figure.add_subplot(grid[i], sharex=rows[0]) for i in (1, 2, 3)]
    for axes in rows[:3]:
        axes.tick_params(labelbottom=False)
    times = draw_deflection(rows[0], run)
    draw_impacts(rows[1], run)
    draw_friction(rows[2], run)
    draw_drag(rows[3], run)
    draw_zoom(figure.add_subplot(grid[4]), run)
    for axes in rows:
        axes.grid(alpha=0.3)
        axes.vlines(sorted(run.epochs.values())[1:], 0, 1, colors='k', lw=0.8, linestyles=':',
                    transform=axes.get_xaxis_transform())
    rows[3].set_xlim(times[0], times[-1])
    figure.suptitle('%s   (%s)' % (os.path.basename(paths[0]), run.title()))
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bags', nargs='+', help='a recording; of a split one all bags')
    parser.add_argument('--node', help='the name of the emulator such as /afm, where the bag holds several')
    parser.add_argument('--output', help='picture to write (png, pdf, svg); default: beside the bag, as .png')
    arguments = parser.parse_args()
    bags = in_order(arguments.bags)
    run = read(bags, arguments.node)
    figure = draw(run, bags)
    output = arguments.output or os.path.splitext(bags[0])[0] + '.png'
    try:
        figure.savefig(output, dpi=144)
    except (OSError, ValueError) as fault:  # no such folder, or no such format
        sys.exit('plot_run.py: %s: %s' % (output, fault))
    print(output)
    for kind, lost in sorted(run.lost.items()):
        print('plot_run.py: warning: %d messages of %s are missing' % (lost, kind), file=sys.stderr)
    return INCOMPLETE if run.lost else 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)

"""What one sees of every shipped scene: the deflection over a few tau with its impacts, and the path over the surface.
The tip is moved by afm.Run, as the node moves it.
"""
import numpy as np
import yaml

from commands import ROOT
from registry import picture

from . import style

# the tau that are drawn
SCENES = {'paper': (4000, 4008), 'resonance': (4000, 4004), 'splash': (4000, 4004), 'glide': (1000, 1004),
          'rest': (0, 4), 'sweep': (4000, 4004), 'slow_motion': (0, 4.5), 'room': (4000, 4008), 'loop': (45000, 47000)}
# name, sign and colour of the kinds of events
KINDS = {0: ('impact', 'o', 'black'), 1: ('chatter sequence', 'D', style.GREEN), 2: ('contact begins', '>', style.PINK),
         3: ('contact ends', '<', style.PINK)}
SAMPLE_RATE_HZ = 1e6  # for the picture: 25 samples to a turn of the horizontal spring
SI_MODEL = ('omega_v_rad_per_s', 'omega_h_rad_per_s', 'tip_mass_kg', 'lattice_spacing_m', 'surface_amplitude_m',
            'rest_height_m', 'restitution_gamma', 'cutoff_speed')
START = ('initial_phase', 'initial_extension', 'initial_height', 'initial_u', 'initial_w')
BATH = ('temperature_k', 'quality_factor', 'lateral_quality_factor', 'kicks_per_tau', 'seed')


def times_of(events):
    return events['tau'] + events['phase']


class Played:
    """A scene: from `begin` to `end` [tau] its samples (time [tau], vertical, lateral [m]) and events; of each command
    of its list, once through, when it came, its eta and the friction at its end."""

    def __init__(self, scene, begin, end):
        import afm  # the other figures do without
        c = {}
        for path in ('emulator.yaml', 'scenes/%s.yaml' % scene):
            c.update(yaml.safe_load((ROOT / 'config' / path).read_text()))
        self.configuration, self.units = c, afm.Units(**{name: c[name] for name in SI_MODEL})
        run = afm.Run(self.units.model, c['drag_velocity'] / self.units.velocity, *(c[name] for name in START),
                      sample_period=1 / (SAMPLE_RATE_HZ * self.units.time), contact_tolerance=c['contact_tolerance'],
                      bath=self.units.bath(*(c[name] for name in BATH)))
        self.samples, self.events, self.commands = [], [], []
        etas = c['commands_eta']
        step = c['commands_hold_s'] / self.units.time if etas else 100.0
        for i in range(int(np.ceil(max(end / step, len(etas) + 1)))):
            if etas:
                run.apply(eta=etas[i % len(etas)])
            batch = run.advance(float((i + 1) * step))
            self.commands.append((i * step, run.eta, batch.friction))
            at = float(batch.first_sample_time) + batch.sample_period * np.arange(len(batch.vertical))
            inside = (at >= begin) & (at < end)
            a = self.units.length
            self.samples.append(np.array([at, a * batch.vertical, a * batch.lateral])[:, inside])
            self.events.append(batch.impacts[(times_of(batch.impacts) >= begin) & (times_of(batch.impacts) < end)])
        self.samples, self.events = np.hstack(self.samples), np.concatenate(self.events)


MOST_TAU, MOST_CELLS = 8.0, 8.0  # of the deflection and of the path that are drawn


def draw_deflection(axes, run):
    times, vertical, lateral = run.samples[:, run.samples[0] < run.samples[0, 0] + MOST_TAU]
    begin = np.floor(times[0])
    line = {} if len(times) > 600 else {'marker': '.', 'ms': 4}  # where single samples are seen, as such
    axes.plot(times - begin, vertical * 1e9, lw=1.2, color=style.BLUE, label='vertical', **line)
    axes.plot(times - begin, lateral * 1e9, lw=1.0, color=style.ORANGE, label='lateral', **line)
    low = min(vertical.min(), lateral.min()) * 1e9
    high = max(vertical.max(), lateral.max()) * 1e9
    axes.set_ylim(low - 0.22 * (high - low), high + 0.06 * (high - low))
    events = run.events[times_of(run.events) < times[-1]]
    for kind, (name, sign, colour) in KINDS.items():
        found = times_of(events[events['kind'] == kind]) - begin
        if len(found):
            look = dict(marker='|', ms=9) if kind == 0 else dict(marker=sign, ms=5)
            axes.plot(found, np.full(len(found), 0.05 + 0.06 * (kind > 0)), linestyle='none', color=colour, label=name,
                      transform=axes.get_xaxis_transform(), **look)
    axes.set_xlabel('model time [$\\tau$]' if begin == 0 else 'model time after %d $\\tau$ [$\\tau$]' % begin)
    axes.set_ylabel('deflection [nm]')
    style.legend_above(axes, columns=5, handletextpad=0.3, columnspacing=0.8, handlelength=1.2)


def draw_path(axes, run):
    """The tip's path over the surface, of a run without changes of the drag velocity."""
    times, vertical, lateral = run.samples
    c = run.configuration
    place = c['initial_phase'] - c['initial_extension'] + run.commands[-1][1] * times + lateral / run.units.length
    place -= np.floor(place[0])  # the first cell is 0
    shown = place < place[0] + MOST_CELLS
    place, height, times = place[shown], 1e9 * (vertical[shown] + c['rest_height_m']), times[shown]
    amplitude = 1e9 * c['surface_amplitude_m']
    xs = np.linspace(place.min(), place.max(), 2000)
    axes.fill_between(xs, amplitude * np.cos(2 * np.pi * xs), -2.2 * amplitude, color=style.SOLID)
    axes.plot(xs, amplitude * np.cos(2 * np.pi * xs), color=style.GREY, lw=1.0)
    axes.plot(place, height, lw=1.3, color=style.BLUE)
    hits = times_of(run.events[run.events['kind'] == 0])
    hits = hits[hits < times[-1]]
    axes.plot(np.interp(hits, times, place), np.interp(hits, times, height), 'o', color='black', ms=3.5)
    axes.set(xlim=(xs[0], xs[-1]), ylim=(-2.2 * amplitude, None), xlabel='position x [a]', ylabel='height y [nm]')
    axes.set_title('path of the tip over the surface', loc='left')


def draw_sweep(axes, run):
    """The last estimate of each command, by the direction it was come from."""
    eta, K = np.array([(eta, friction['k_f_work']) for _, eta, friction in run.commands]).T
    top = int(np.argmax(eta))
    axes.plot(eta[:top + 1], K[:top + 1], '-^', ms=5, lw=1.0, color=style.BLUE, label='$\\eta$ rising')
    axes.plot(eta[top:], K[top:], '--v', ms=5, lw=1.0, color=style.ORANGE, label='$\\eta$ falling', **style.OPEN)
    axes.set(xlabel=style.ETA_LABEL, ylabel=style.K_F_LABEL, yscale='log')
    style.legend_above(axes)


def draw_loop(axes, run):
    """The lateral force over the holder's position, sampled and averaged, once there and back."""
    times, _, lateral = run.samples
    c = run.configuration
    force, mean = -c['tip_mass_kg'] * c['omega_h_rad_per_s'] ** 2 * lateral * 1e9, []
    first = next(i for i, (at, eta, _) in enumerate(run.commands) if at > times[0] and eta > 0)
    for name, i, look in (('trace', first, dict(color=style.BLUE, ls='-')),
                          ('retrace', first + 1, dict(color=style.ORANGE, ls='--'))):
        (begin, eta, friction), stop = run.commands[i], run.commands[i + 1][0]
        inside = (times >= begin) & (times < stop)
        position = eta * (times[inside] - begin) * run.units.length * 1e9
        position -= position.min()
        bins = np.arange(0, 10 * (position.max() // 10), 10.0)
        which = np.digitize(position, bins)
        steady = times[inside] > begin + 60  # without the change of direction
        mean.append(force[inside][steady].mean())
        axes.plot(bins + 5, [force[inside][which == i + 1].mean() for i in range(len(bins))], lw=1.4,
                  label='%s, mean %.3g nN' % (name, mean[-1]), **look)
        axes.axhline(mean[-1], lw=0.8, **look)
    axes.axhline(0, color='black', lw=0.6)
    axes.set_title('half the opening %.3g nN; $K_f v_0$ = %.3g nN' % (
        0.5 * (mean[0] - mean[1]), 1e9 * friction['k_f_work'] * abs(eta) * run.units.force), loc='left')
    axes.set(xlabel='position of the holder [nm]', ylabel='lateral force, means over 10 nm [nN]')
    axes.legend(loc='center')


def draw_speeds(axes, run):
    bounces = run.events[run.events['kind'] == 0]  # a chatter sequence has the time of its end
    axes.semilogy(times_of(bounces), 1e6 * run.units.velocity * bounces['normal_speed'], 'o', ms=4, color='black')
    axes.set(xlabel='model time [$\\tau$]', ylabel='normal speed of impacts [$\\mu$m/s]')


def add_picture(scene, bounds):
    @picture(name='scene_' + scene)
    def draw(_):
        run = Played(scene, *bounds)
        figure, (left, right) = style.new(3.3, 1, 2)
        draw_deflection(left, run)
        {'sweep': draw_sweep, 'loop': draw_loop, 'rest': draw_speeds}.get(scene, draw_path)(right, run)
        return figure


for scene_and_bounds in SCENES.items():
    add_picture(*scene_and_bounds)

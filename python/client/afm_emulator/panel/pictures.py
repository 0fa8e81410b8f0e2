"""The four pictures of the panel."""
from pathlib import Path as FilePath

import numpy as np
from PyQt5 import QtCore  # noqa: F401: pyqtgraph takes the Qt that is there
import pyqtgraph as pg
import roslib.packages

from .signals import Scale, envelope

BLUE, ORANGE, GREEN, GREY = '#0072B2', '#D55E00', '#009E73', '#909090'  # Okabe and Ito
ENERGIES = ((0.0, '#56B4E9'), (0.1, '#009E73'), (1.0, '#E69F00'), (10.0, '#D55E00'))  # from so much on [zJ]: a colour
ZEPTO, PICO = 1e-21, 1e-12
BUCKETS = 250         # of a signal across a picture, each with its least and its greatest value: no peak is lost
PATH_CELLS = 6.0
SPANS = (2, 5, 10, 50, 200, 1000)  # tau

pg.setConfigOptions(background='w', foreground='k')


def friction_curve():
    """(eta, K_f) of FIG. 1."""
    table = FilePath(roslib.packages.get_pkg_dir('afm_emulator')) / 'config' / 'fig1.csv'
    return np.loadtxt(str(table), delimiter=',', skiprows=2)


class Line(pg.PlotCurveItem):
    """Takes half the time of a PlotDataItem, and does not look for its bounds at every change: we choose those of the
    axes."""

    def boundingRect(self):
        view = self.getViewBox()  # pyqtgraph 0.13's viewRect() of a curve is that of its first call
        return super().boundingRect() if view is None else view.viewRect()


class Plot(pg.PlotWidget):
    """With bounds that we choose, and none of what a mouse could spoil."""

    def __init__(self, title, left, bottom, least_span=(1.0, 1.0), patience=12):
        super().__init__()
        self.setTitle(title, size='10pt')
        self.setLabel('left', left)
        self.setLabel('bottom', bottom)
        self.setMenuEnabled(False)
        self.hideButtons()
        self.setMouseEnabled(False, False)
        self.showGrid(True, True, 0.15)
        self.getPlotItem().getAxis('left').setWidth(70)  # one place for all, so that axes stand under each other
        for side in ('left', 'bottom'):
            axis = self.getPlotItem().getAxis(side)
            axis.enableAutoSIPrefix(False)
            axis.setCacheMode(pg.AxisItem.DeviceCoordinateCache)  # else drawn with its grid at every frame
        self.disableAutoRange()
        self._scales = [Scale(span, patience) for span in least_span]
        self._is_live = True

    def show_live(self, live):
        if live != self._is_live:
            self._is_live = live
            self.setBackground('w' if live else '#d0d0d0')

    def line(self, colour, **options):
        curve = Line(pen=colour, **options)
        self.addItem(curve)
        return curve

    def note(self, html):
        """At the top, inside."""
        label = pg.LabelItem(html, size='8pt')
        label.setParentItem(self.getPlotItem().getViewBox())
        label.anchor(itemPos=(0.5, 0.0), parentPos=(0.5, 0.0), offset=(0, 2))

    def fit_y(self, *values):
        values = [v for v in values if len(v)]
        if values and self._scales[1].update(min(v.min() for v in values), max(v.max() for v in values)):
            self.setYRange(self._scales[1].low, self._scales[1].high, padding=0.02)

    def fit_x(self, low, high):
        if self._scales[0].update(low, high):
            self.setXRange(self._scales[0].low, self._scales[0].high, padding=0.0)


class Scope:
    """Vertical and lateral deflection over the same time."""

    def __init__(self):
        self.vertical = Plot('Oscilloscope', 'vertical [pm]', '', (1.0, 20.0))
        self.lateral = Plot(None, 'lateral [pm]', 'time from the trigger [τ]', (1.0, 4.0))
        self.vertical.getPlotItem().getAxis('bottom').setStyle(showValues=False)
        self._Y, self._X = self.vertical.line(BLUE), self.lateral.line(ORANGE)
        self._span = self._triggered = None

    def draw(self, t, Y, X, span, spacing_pm, triggered):
        for plot, curve, y in ((self.vertical, self._Y, Y * spacing_pm), (self.lateral, self._X, X * spacing_pm)):
            curve.setData(*envelope(t, y, BUCKETS))
            plot.fit_y(y)
            if span != self._span:
                plot.setXRange(0.0, span, padding=0.0)
        self._span = span
        if triggered != self._triggered:
            self._triggered = triggered
            self.vertical.setTitle('Oscilloscope, ' + ('triggered' if triggered else 'free running'), size='10pt')

    def clear(self):
        for curve in (self._Y, self._X):
            curve.setData([], [])


class Path:
    """The tip over the surface, from the trigger on."""

    def __init__(self):
        self.plot = Plot('Path of the tip over the surface', 'height [pm]', 'along the surface [nm]', (0.1, 20.0))
        bounds = ['&lt; %g' % above for above, _ in ENERGIES[1:]] + ['&ge; %g' % ENERGIES[-1][0]]
        self.plot.note('impacts [zJ]: ' + ' '.join(
            '<span style="color:%s">&#9679;</span> %s' % (colour, bound)
            for (_, colour), bound in zip(ENERGIES, bounds)))
        self._surface = self.plot.line('#777777', fillLevel=-1e6, brush=pg.mkBrush('#e4e4e4'))
        self._line = self.plot.line(BLUE)
        self._spots = pg.ScatterPlotItem(size=8, pen=pg.mkPen('w', width=0.5), pxMode=True)
        self.plot.addItem(self._spots)
        self._tip = pg.ScatterPlotItem(size=12, symbol='t', pen=None, brush='k')
        self.plot.addItem(self._tip)
        self._brushes = [pg.mkBrush(colour) for _, colour in ENERGIES]
        self._nm = None
        self._least = np.array([least for least, _ in ENERGIES]) * ZEPTO

    def draw(self, x, y, spots, low, settings, shows_tip):
        """x, y: of the tip; spots: (x, energy lost). low: left end of the picture. All in cells, but the energy."""
        nm, pm = 1e9 * settings.lattice_spacing_m, 1e12 * settings.lattice_spacing_m
        amplitude = settings.surface_amplitude_m / settings.lattice_spacing_m
        ground = np.linspace(0.0, PATH_CELLS, 97)
        profile = amplitude * np.cos(2 * np.pi * (ground + low))
        y = np.maximum(y, amplitude * np.cos(2 * np.pi * x))  # a chord between two samples in contact cuts the crest
        self._surface.setData(nm * ground, pm * profile)
        self._line.setData(nm * (x - low), pm * y)
        self._spots.setData(nm * (spots[0] - low), pm * amplitude * np.cos(2 * np.pi * spots[0]),
                            brush=[self._brushes[i] for i in np.searchsorted(self._least, spots[1], 'right') - 1])
        self._tip.setVisible(shows_tip)
        if shows_tip:
            self._tip.setData(nm * (x[-1:] - low), pm * y[-1:])
        if nm != self._nm:
            self.plot.setXRange(0.0, nm * PATH_CELLS, padding=0.0)
            self._nm = nm
        top, bottom = max(y.max(), amplitude), min(y.min(), -amplitude)
        self.plot.fit_y(pm * np.array([bottom, top + 0.1 * (top - bottom)]))  # and the note above it

    def clear(self):
        for part in (self._surface, self._line, self._spots):
            part.setData([], [])
        self._tip.setVisible(False)


class Loop:
    def __init__(self):
        self.plot = Plot('Friction loop: <span style="color:%s">trace</span>, <span style="color:%s">retrace</span>' %
                         (BLUE, ORANGE), 'lateral force [pN]', 'position of the holder [nm]', (10.0, 20.0), patience=5)
        self._lines = {1: self.plot.line(BLUE), -1: self.plot.line(ORANGE)}
        self.plot.addItem(pg.InfiniteLine(0.0, 0, pen='#bbbbbb'))

    def draw(self, loop):
        lines = loop.lines
        now = lines.get(loop.direction)
        if now is None or not now.shape[1]:
            for line in self._lines.values():
                line.setData([], [])
            return
        before = lines[-loop.direction]
        if before.shape[1] and (np.ptp(now[0]) > 2.0 * np.ptp(before[0]) or now[0].min() > before[0].max() or
                                now[0].max() < before[0].min()):
            before = before[:, :0]  # this is no loop any more
        origin = min(line[0].min() for line in (now, before) if line.shape[1])
        shown = {loop.direction: now, -loop.direction: before}
        for way, (x, force) in shown.items():
            self._lines[way].setData(*envelope(1e9 * (x - origin), force / PICO, BUCKETS))
        self.plot.fit_x(0.0, 1e9 * max(line[0].max() - origin for line in shown.values() if line.shape[1]))
        self.plot.fit_y(*(line[1] / PICO for line in shown.values()))


class Curve:
    """The running estimate, on the friction curve of the paper."""

    def __init__(self, curve):
        self.plot = Plot('Friction; grey: FIG. 1', 'K<sub>f</sub> [m<sub>tip</sub>/τ]', 'drag speed η [a/τ]',
                         (1.0, 1.0))
        self.plot.line('#aaaaaa').setData(curve[:, 0], curve[:, 1])
        self._curve = curve
        self._trail = self.plot.plot([], [], pen=None, symbol='o', symbolSize=4, symbolPen=None, symbolBrush=GREEN)
        self._error = pg.ErrorBarItem(x=np.zeros(1), y=np.zeros(1), height=np.zeros(1), beam=0.1,
                                       pen=pg.mkPen(ORANGE, width=2))
        self._now = self.plot.plot([], [], pen=None, symbol='o', symbolSize=9, symbolPen='w', symbolBrush=ORANGE)
        self.plot.addItem(self._error)

    def draw(self, trail):
        eta, k_f = trail.past
        self._trail.setData(eta, k_f)
        reach = [self._curve[-1, 0]]
        tall = [self._curve[:, 1], np.zeros(1)]
        self._error.setVisible(trail.now is not None)
        if trail.now is None:
            self._now.setData([], [])
        else:
            x, y, error = trail.now
            self._now.setData([x], [y])
            self._error.setData(x=np.array([x]), y=np.array([y]),
                                height=np.array([2.0 * error if np.isfinite(error) else 0.0]))
            reach.append(x)
            tall.append(np.array([y]))
        self.plot.fit_x(0.0, max(reach))
        self.plot.fit_y(*tall, k_f)

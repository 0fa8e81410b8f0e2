"""The window: it takes what has come 30 times a second, draws it, and sends what is turned and pressed."""
import math

import numpy as np
from PyQt5 import QtCore, QtWidgets

from .knobs import Knob, Lamp, Spin
from .link import LATEST
from .pictures import PATH_CELLS, PICO, SPANS, Curve, Loop, Path, Scope
from .signals import FINE_SAMPLES, TRIGGER_SEARCH, FrictionLoop, Motion, Recent, Trail

FRAME_MS = 33
SLOW_FRAMES = 6     # the numbers, the curve and the loop follow every sixth frame: who could read them faster
SLOW_TAU = 2.0      # per frame: slower than that an eye follows, and the newest is shown instead of what was triggered
GONE_S, DOUBT_S = 1.5, 0.3  # of silence: a status comes 10 times a second
LAG_S = 0.1         # a lamp goes yellow
SILENT, REPLAY = 'no emulator: waiting for %s', 'a recording is played: knobs have no effect'
READOUT = '<span style="color: #666">%s</span><br><span style="font-size: 14pt; font-weight: bold">%s</span> %s'
UNDEFINED, NOT_YET = 'undefined', '–'  # the second: no estimate of this run has come
RECORD, END_RECORDING = '● Record', '■ End recording'


def with_error(value, error):
    """Two digits of the error."""
    if not math.isfinite(value):
        return UNDEFINED
    digits = min(max(1 - math.floor(math.log10(error)), 0), 5) if math.isfinite(error) and error > 0.0 else 3
    return '%.*f ± %.*f' % (digits, value, digits, error) if math.isfinite(error) else '%.3f' % value


class Window(QtWidgets.QWidget):
    def __init__(self, link, curve, lever=''):
        """lever: its name and that of the surface; the emulator publishes numbers alone."""
        super().__init__()
        self.link, self._lever_name = link, lever
        self.recent, self.loop, self.trail = Recent(), FrictionLoop(), Trail()
        self.scope, self.path, self.loop_plot, self.curve = Scope(), Path(), Loop(), Curve(curve)
        self._frame, self._run = -1, 0
        self.setWindowTitle('AFM emulator ' + link.name)
        self._lay_out()
        self.resize(1000, 700)
        self.refresh()
        self._timer = QtCore.QTimer(self, interval=FRAME_MS, timerType=QtCore.Qt.PreciseTimer, timeout=self.refresh)
        self._timer.start()

    # the desk

    def _lay_out(self):
        self.banner = QtWidgets.QLabel(objectName='banner',
                                       styleSheet='background: #D55E00; color: white; padding: 3px;')
        self.readouts, head = {}, QtWidgets.QHBoxLayout()
        for name in ('drag', 'eta', 'friction', 'force', 'impacts'):
            self.readouts[name] = QtWidgets.QLabel(objectName=name + '_readout')
            head.addWidget(self.readouts[name])
        self.desk, pictures = QtWidgets.QWidget(), QtWidgets.QGridLayout()
        pictures.setSpacing(4)
        self.plots = [self.scope.vertical, self.scope.lateral, self.path.plot, self.curve.plot, self.loop_plot.plot]
        for plot, place in zip(self.plots, ((0, 0), (1, 0), (2, 0), (0, 1, 2, 1), (2, 1))):
            pictures.addWidget(plot, *place)
        for row, share in enumerate((5, 4, 8)):
            pictures.setRowStretch(row, share)
        pictures.setColumnStretch(0, 1)
        pictures.setColumnStretch(1, 1)
        column = QtWidgets.QVBoxLayout(self.desk)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(3)
        self.controls = self._knobs() + self._buttons()
        for part in self.controls + self._picture_buttons():
            column.addWidget(part)
        column.addStretch(1)
        self.lamps_column, self.lamps = QtWidgets.QVBoxLayout(), {}
        self.lamps_column.setSpacing(2)
        column.addLayout(self.lamps_column)
        self.lever = QtWidgets.QLabel(objectName='lever', wordWrap=True)
        column.addWidget(self.lever)
        self.desk.setFixedWidth(246)
        whole = QtWidgets.QGridLayout(self)
        whole.setContentsMargins(6, 4, 6, 6)
        whole.addLayout(head, 0, 0, 1, 2)
        whole.addWidget(self.banner, 1, 0, 1, 2)
        whole.addWidget(self.desk, 2, 0)
        whole.addLayout(pictures, 2, 1)
        whole.setRowStretch(2, 1)
        whole.setColumnStretch(1, 1)

    def _knobs(self):
        """Units in SI; those that depend on the lever and on the surface come with them. Wide ranges: a knob shows
        whatever holds, and the emulator says what it refuses."""
        self.drag = Knob('Drag', [Spin('drag_um_s', ' µm/s', 3, 0.1, -1e6, 1e6),
                                  Spin('eta', ' η', 3, 0.01, -1e3, 1e3)],
                         (1e-6, 3.3104e-6), (-10.0, 10.0))
        self.load = Knob('Load', [Spin('load_pn', ' pN', 1, 1.0, -1e9, 1e9),
                                  Spin('height_pm', ' pm', 1, 1.0, -1e9, 1e9)],
                         (-1.5e-12, 1e-12))
        self.gamma = Knob('Restitution γ', [Spin('gamma', '', 3, 0.01, 0.0, 1.0)], (1.0,), (0.0, 1.0))
        self.temperature = Knob('Temperature', [Spin('temperature', ' K', 1, 10.0, 0.0, 1e9)], (1.0,))
        self.quality = Knob('Q of the lever', [Spin('quality', '', 1, 10.0, 0.0, 1e9)], (1.0,))
        self.drag.turned.connect(lambda value: self.link.command('drag_velocity', value))
        self.load.turned.connect(lambda value: self.link.command('rest_height', value))
        for knob, name in ((self.gamma, 'restitution_gamma'), (self.temperature, 'temperature_k'),
                           (self.quality, 'quality_factor')):
            knob.turned.connect(lambda value, name=name: self.link.set_parameter(name, value))
        return [self.drag, self._row(self._button('reverse', 'Reverse', self.reverse),
                                     self._button('stop', 'Stop', lambda: self.drag.turn_to(0.0))),
                self.load, self.gamma, self.temperature, self.quality]

    def _buttons(self):
        self.pause = self._button('pause', 'Pause', lambda: self.link.pause(not self._status('paused')))
        self.record = self._button('record', RECORD, lambda: self.link.record(not self._status('recording')))
        self.steps = [self._button('step_tau', 'Step 1 τ', lambda: self.link.step(tau=1.0)),
                      self._button('step_impact', 'Step impact', lambda: self.link.step(impacts=1))]
        return [self._row(self.pause, self._button('reset', 'Reset', self.link.reset)), self._row(*self.steps),
                self.record]

    def _picture_buttons(self):
        self.hold = self._button('hold', 'Hold pictures', lambda: None, checkable=True)
        self.span = QtWidgets.QComboBox(objectName='span')
        for span in SPANS:
            self.span.addItem('%d τ' % span, span)
        self.span.setCurrentIndex(1)
        return [self._row(QtWidgets.QLabel('Time base'), self.span),
                self._row(self.hold, self._button('clear', 'Clear trail', self.trail.clear))]

    @staticmethod
    def _button(name, text, pressed, **options):
        button = QtWidgets.QPushButton(text, objectName=name, **options)
        button.setStyleSheet('padding: 3px;')
        button.setMinimumWidth(20)
        button.clicked.connect(lambda: pressed())
        return button

    @staticmethod
    def _row(*parts):
        row = QtWidgets.QWidget()
        layout = QtWidgets.QHBoxLayout(row)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for part in parts:
            layout.addWidget(part, 1)
        return row

    def closeEvent(self, event):
        self._timer.stop()
        super().closeEvent(event)

    # what is pressed

    def reverse(self):
        self.drag.turn_to(-self.link.latest('applied').drag_velocity)

    # what has come

    def _status(self, field, default=None):
        return getattr(self.link.latest('status'), field, default)

    def refresh(self):
        self._frame += 1
        settings, applied, status = (self.link.latest(topic) for topic in ('configuration', 'applied', 'status'))
        ready = self.link.silence() < GONE_S and None not in (settings, applied, status)
        controls = ready and self.link.takes_commands()
        for plot in self.plots:
            plot.show_live(ready)
        begins = controls and not self.load.isEnabled()
        for part in self.controls:
            part.setEnabled(controls)
        self.desk.setEnabled(ready)
        if ready:
            if self._run != self.link.run:
                self._begin()
            self._take(settings)
            if not self.hold.isChecked():
                self._draw(settings, applied)
        if begins or self._frame % SLOW_FRAMES == 0:  # a knob needs the units of the lever from the first
            self._show_state(ready, controls)

    def _begin(self):
        """A new epoch, or another emulator: while it is paused nothing comes that shows it."""
        self._run = self.link.run
        self.recent.clear()
        self.loop.clear()
        self.trail.end_run()

    def _take(self, settings):
        tau_s = 2 * math.pi / settings.omega_v_rad_per_s
        stiffness = settings.tip_mass_kg * settings.omega_h_rad_per_s ** 2
        for applied in self.link.changes():
            self.recent.change(applied)
        for batch, impacts in self.link.batches():
            if batch.epoch != settings.epoch:  # it was waiting for its impacts
                continue
            if not self.recent.add(batch, impacts):
                self.loop.clear()
            self.loop.add(batch, stiffness, tau_s)

    def _draw(self, settings, applied):
        if not self.recent.batches:
            self.scope.clear()
            self.path.clear()
            return
        span, spacing = float(self.span.currentData()), settings.lattice_spacing_m
        direction = -1.0 if applied.drag_velocity < 0.0 else 1.0
        tau_s = 2 * math.pi / settings.omega_v_rad_per_s
        amplitude = settings.surface_amplitude_m / spacing
        samples, impacts = self.recent.last(span + TRIGGER_SEARCH, spacing, tau_s)
        motion = Motion(samples, impacts, amplitude, settings.omega_h_rad_per_s * tau_s)
        rolls = self._status('paused') or settings.time_scale * FRAME_MS * 1e-3 / tau_s < SLOW_TAU
        begin = None if rolls else motion.trigger(span, direction)
        triggered = begin is not None
        if not triggered:
            begin = max(motion.t[-1] - span, motion.t[0])
        seen = motion.within(begin, begin + span)
        t, Y, X, height = motion.t[seen], motion.Y[seen], motion.X[seen], motion.height[seen]
        self.scope.draw(t - begin, Y, X, span, 1e12 * spacing, triggered)
        x = motion.xc[seen] + X
        if triggered:
            low = math.floor(x[0]) - (direction < 0.0) * (PATH_CELLS - 1)
        else:
            low = x[-1] - (0.5 + 0.4 * np.sign(applied.drag_velocity)) * PATH_CELLS
        shown = np.flatnonzero((x >= low - 1) & (x <= low + PATH_CELLS + 1))[-4 * FINE_SAMPLES:]
        at = impacts[:, (impacts[0] >= begin) & (impacts[0] <= begin + span)]
        places = at[1] + np.round(np.interp(at[0], t, x) - at[1])
        self.path.draw(x[shown], (Y + height)[shown], (places, at[2]), low, settings, not triggered)

    def _show_state(self, ready, controls):
        self.banner.setVisible(not controls)
        self.banner.setText(REPLAY if ready and self.link.silence() < DOUBT_S else SILENT % self.link.name)
        if not ready:
            return
        settings, applied, friction, status = (self.link.latest(topic) for topic in LATEST)
        self._follow(settings, applied)
        if friction is not None and friction.epoch != settings.epoch:  # it comes late
            friction = None
        k_f, force = NOT_YET, NOT_YET
        if friction is not None:
            unit = friction.k_f_work_natural / friction.k_f_work if friction.k_f_work else math.nan
            error = friction.k_f_work_std_error * unit
            k_f, force = with_error(friction.k_f_work_natural, error), '%.1f' % (friction.mean_lateral_force / PICO)
        if not self.hold.isChecked():
            self.loop_plot.draw(self.loop)
            if friction is not None:
                self.trail.add(friction.eta, friction.k_f_work_natural, error)
            self.curve.draw(self.trail)
        self._read_out(applied.drag_velocity, k_f, force, status)
        self.pause.setText('Go on' if status.paused else 'Pause')
        self.record.setText(END_RECORDING if status.recording else RECORD)
        self.record.setStyleSheet('padding: 3px;' + 'color: #D00000;' * bool(status.recording))
        for button in self.steps:
            button.setEnabled(status.paused)
        self._light(status)

    def _read_out(self, drag_velocity, k_f, force, status):
        for name, title, value, unit in (
                ('drag', 'drag speed', '%.3f' % (1e6 * drag_velocity), 'µm/s'),
                ('eta', 'in cells per τ', 'η = %.3f' % (drag_velocity / self.drag.units[1]), ''),
                ('friction', 'friction K<sub>f</sub>', k_f, 'm<sub>tip</sub>/τ'),
                ('force', 'mean lateral force', force, 'pN'),
                ('impacts', 'impacts', '%.2f' % status.impacts_per_tau, '/τ')):
            self.readouts[name].setText(READOUT % (title, value, unit if value not in (UNDEFINED, NOT_YET) else ''))

    def _follow(self, settings, applied):
        tau_s = 2 * math.pi / settings.omega_v_rad_per_s
        stiffness = settings.tip_mass_kg * settings.omega_v_rad_per_s ** 2
        self.drag.units[1], self.load.units[0] = settings.lattice_spacing_m / tau_s, -1e-12 / stiffness
        for knob, value in ((self.drag, applied.drag_velocity), (self.load, applied.rest_height_m),
                            (self.gamma, applied.restitution_gamma), (self.temperature, applied.temperature_k),
                            (self.quality, applied.quality_factor)):
            knob.follow(value)
        self.lever.setText('%s%.3g N/m, %.4g kHz, lateral %.3g N/m, %s' % (
            self._lever_name and self._lever_name + ': ', stiffness, 1e-3 / tau_s,
            settings.tip_mass_kg * settings.omega_h_rad_per_s ** 2, applied.model))

    def _light(self, status):
        states = {'pace': (Lamp.GREEN if status.lag < LAG_S else Lamp.YELLOW, 'real-time factor %.3f, lag %.3f s' % (
            status.real_time_factor, status.lag))}
        if status.paused:
            states['pace'] = (Lamp.GREY, 'paused')
        for name, diagnosis in list(self.link.diagnostics.items()):
            states[name] = Lamp.BY_LEVEL[min(diagnosis.level, 3)], '%s: %s' % (name, diagnosis.message)
        if self.link.notes:
            states['note'] = (Lamp.GREY, self.link.notes[-1])
        for name, state in states.items():
            if name not in self.lamps:
                self.lamps[name] = Lamp(name)
                self.lamps_column.addWidget(self.lamps[name])
            self.lamps[name].show_state(*state)

"""What an operator turns and presses, and what lights up."""
import math
import time

from PyQt5 import QtCore, QtGui, QtWidgets

OWN_S = 1.0     # for so long after a turn a knob shows what was asked for, and not yet what holds
SLIDER_STEPS = 1000
MANY = 1e4       # from here on without decimals, for which there is no room
TEXT_WIDTH = 228  # of a lamp
LAMP = 'border-radius: 5px; border: 1px solid #777; background: %s;'


class Spin(QtWidgets.QDoubleSpinBox):
    """A number with its unit, also as 1e3. It speaks when it is entered, not while it is typed."""

    def __init__(self, name, suffix, decimals, step, low, high):
        super().__init__(objectName=name, keyboardTracking=False, decimals=decimals, singleStep=step, minimum=low,
                         maximum=high)
        self.setSuffix(suffix)
        self.setLocale(QtCore.QLocale.c())  # a decimal point everywhere
        self.setAlignment(QtCore.Qt.AlignRight)
        self.setMinimumWidth(40)

    def valueFromText(self, text):
        return float(text[:len(text) - len(self.suffix())] if text.endswith(self.suffix()) else text)

    def textFromValue(self, value):
        return '%.0f' % value if abs(value) >= MANY else super().textFromValue(value)

    def validate(self, text, at):
        try:
            fits = self.minimum() <= self.valueFromText(text) <= self.maximum()
        except ValueError:
            fits = False
        return QtGui.QValidator.Acceptable if fits else QtGui.QValidator.Intermediate, text, at

    def fixup(self, text):
        return text  # Qt makes 15 of 1,5; so the value stays

    def is_in_use(self):
        return self.hasFocus() and self.lineEdit().isModified()


class Knob(QtWidgets.QWidget):
    """One quantity, in SI, on one or two spin boxes with their units, and on a slider if it has a range for one."""
    turned = QtCore.pyqtSignal(float)  # SI

    def __init__(self, title, spins, units, slider=None):
        """units: SI units per unit of each box; slider: (low, high), in the unit of the last box."""
        super().__init__()
        self.spins, self.units, self._turned_at, self._quiet = spins, list(units), -math.inf, False
        self.slider = None
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 2, 0, 2)
        column.setSpacing(1)
        row = QtWidgets.QHBoxLayout()
        row.setSpacing(4)
        label = QtWidgets.QLabel(title)
        row.addWidget(label, 0)
        for which, spin in enumerate(spins):
            row.addWidget(spin, 2)
            spin.valueChanged.connect(lambda value, which=which: self._turn(which, value))
        column.addLayout(row)
        if slider is not None:
            self._low, self._span = slider[0], slider[1] - slider[0]
            self.slider = QtWidgets.QSlider(QtCore.Qt.Horizontal, objectName=spins[-1].objectName() + '_slider',
                                            maximum=SLIDER_STEPS)
            self.slider.valueChanged.connect(
                lambda at: self._turn(len(self.units) - 1, self._low + self._span * at / SLIDER_STEPS))
            column.addWidget(self.slider)

    def _turn(self, which, value):
        if not self._quiet:
            self._turned_at = time.monotonic()
            self._show(value * self.units[which], but=self.sender())
            self.turned.emit(value * self.units[which])

    def _show(self, value, but=None):
        self._quiet = True
        for spin, unit in zip(self.spins, self.units):
            if spin is not but and not spin.is_in_use():
                spin.setValue(value / unit + 0.0)  # no -0
        if self.slider is not None and self.slider is not but and not self.slider.isSliderDown():
            self.slider.setValue(round(SLIDER_STEPS * (value / self.units[-1] - self._low) / self._span))
        self._quiet = False

    def turn_to(self, value):
        """As if it were turned [SI]."""
        self._turned_at = time.monotonic()
        self._show(value)
        self.turned.emit(value)

    def follow(self, value):
        """The value that holds [SI]."""
        if time.monotonic() - self._turned_at > OWN_S:
            self._show(value)


class Lamp(QtWidgets.QWidget):
    GREY, GREEN, YELLOW, RED = '#dddddd', '#009E73', '#F0C000', '#D55E00'
    BY_LEVEL = GREEN, YELLOW, RED, RED  # of diagnostic_msgs/DiagnosticStatus

    def __init__(self, text):
        super().__init__()
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.bulb, self.label = QtWidgets.QLabel(), QtWidgets.QLabel(text)
        self.bulb.setFixedSize(11, 11)
        self.label.setWordWrap(True)
        self.label.setAlignment(QtCore.Qt.AlignTop)
        row.addWidget(self.bulb, 0, QtCore.Qt.AlignTop)
        row.addWidget(self.label, 1)
        self._shown = None
        self.show_state(self.GREY, text)

    def show_state(self, colour, text):
        if (colour, text) != self._shown:
            self._shown = (colour, text)
            self.bulb.setStyleSheet(LAMP % colour)
            self.label.setText(text)
            self.label.setToolTip(text)
            self.label.setMinimumHeight(self.label.heightForWidth(TEXT_WIDTH))  # a small window would cut it

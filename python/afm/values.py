"""What the module's functions return, beside arrays."""
import enum
import math
from typing import Any, Dict, NamedTuple

import numpy as np


def _document(class_, **fields):
    for name, text in fields.items():
        getattr(class_, name).__doc__ = text


class Kind(enum.IntEnum):
    """What an event is, as in the messages: IMPACT, BURST, CONTACT_BEGUN or CONTACT_ENDED; each has a docstring."""

    IMPACT = 0
    BURST = 1
    CONTACT_BEGUN = 2
    CONTACT_ENDED = 3


_document(Kind, IMPACT='one impact',
          BURST='a chatter sequence as one event: `count` bounces and all the energy that they lose',
          CONTACT_BEGUN='the tip no longer bounces: the surface presses on it from here on',
          CONTACT_ENDED='the surface lets go, and the tip flies')


class ModelTime(NamedTuple):
    """A time in whole tau and a phase in [0, 1): no digit is lost however long the run. float() gives tau."""

    tau: int
    phase: float

    def __float__(self) -> float:
        return self.tau + self.phase

    def after(self, duration: float) -> 'ModelTime':
        """The time `duration` [tau] later."""
        total = self.phase + duration
        whole = math.floor(total)
        phase = total - whole
        return ModelTime(self.tau + int(whole), phase) if phase < 1.0 else ModelTime(self.tau + int(whole) + 1, 0.0)


class State(NamedTuple):
    """Where the tip is, in the lab."""

    phase: float
    extension: float
    y: float
    u: float
    w: float


_document(State, phase='of the surface, crest = 0 [a]', extension='x - xc [a]', y='height above mid-surface [a]',
          u='horizontal velocity [a/tau]', w='vertical velocity [a/tau]')


class Samples(NamedTuple):
    """Evenly spaced samples of the deflection, and the events in their time."""

    time: ModelTime
    period: float
    vertical: np.ndarray
    lateral: np.ndarray
    events: np.ndarray

    @property
    def times(self) -> np.ndarray:
        """of each sample: (n,) [tau]"""
        return float(self.time) + self.period * np.arange(len(self.vertical))


_document(Samples, time='of the first sample', period='from sample to sample [tau]', vertical='(n,): y - y0 [a]',
          lateral='(n,): x - xc [a]', events='(m,): as of Tip.advance')


class Batch(NamedTuple):
    """What Run.advance() has produced."""

    begin: ModelTime
    end: ModelTime
    first_sample: int
    first_sample_time: ModelTime
    sample_period: float
    vertical: np.ndarray
    lateral: np.ndarray
    first_impact: int
    impacts: np.ndarray
    eta: float
    holder: float
    friction: Dict[str, Any]


_document(Batch, begin='of the advance', end='of the advance', first_sample='running index of the first sample',
          first_sample_time='of the first sample', sample_period='at the end [tau]', vertical='(n,): y - y0 [a]',
          lateral='(n,): x - xc [a]', first_impact='running index of the first event',
          impacts='(m,): as of Tip.advance', eta='drag velocity [a/tau]',
          holder='position of the holder at first_sample_time [a]',
          friction='the estimate at the end: a dict with the fields of the topic ~friction, in natural units. Friction '
                   'is k_f_work [m_tip/tau], by the work of the drag; k_f counts the losses in impacts, and agrees '
                   'without a bath alone')


class Lyapunov(NamedTuple):
    """Lyapunov exponents of the map from impact to impact, largest first."""

    exponents: np.ndarray
    std_errors: np.ndarray
    outcome: str
    rank: int
    volume_rate: float
    duration: float
    events: int


_document(Lyapunov, exponents='(4,) [1/tau]; after a contact the last two are minus infinity, of a hammer too',
          std_errors='(4,) [1/tau]', outcome='measured, budget_spent, no_event, search_failed or no_number',
          rank='how many exponents are finite', duration='measured [tau]',
          volume_rate='what their sum must be [1/tau], of a hammer that of its two; NaN after a chatter sequence: '
                      'contact_tolerance=0 has none',
          events='on the way')

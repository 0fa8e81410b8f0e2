"""What the module's functions return, beside arrays."""
import enum
import math
from typing import Any, Dict, NamedTuple

import numpy as np


class Kind(enum.IntEnum):
    """Of an event, as in the messages."""

    IMPACT = 0
    BURST = 1
    CONTACT_BEGUN = 2
    CONTACT_ENDED = 3


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

    phase: float  # of the surface, crest = 0 [a]
    extension: float  # x - xc [a]
    y: float  # height above mid-surface [a]
    u: float  # horizontal velocity [a/tau]
    w: float  # vertical velocity [a/tau]


class Samples(NamedTuple):
    """Evenly spaced samples of the deflection, and the events in their time."""

    time: ModelTime  # of the first sample
    period: float  # [tau]
    vertical: np.ndarray  # (n,): y - y0 [a]
    lateral: np.ndarray  # (n,): x - xc [a]
    events: np.ndarray  # (m,): as of Tip.advance

    @property
    def times(self) -> np.ndarray:
        """(n,) [tau]"""
        return float(self.time) + self.period * np.arange(len(self.vertical))


class Batch(NamedTuple):
    """What a stretch of an Emulator's run has produced."""

    begin: ModelTime
    end: ModelTime
    first_sample: int  # running index
    first_sample_time: ModelTime
    sample_period: float  # [tau], at the end
    vertical: np.ndarray  # (n,): y - y0 [a]
    lateral: np.ndarray  # (n,): x - xc [a]
    first_impact: int  # running index
    impacts: np.ndarray  # (m,): as of Tip.advance
    eta: float  # drag velocity at the end [a/tau]
    friction: Dict[str, Any]  # at the end; the fields of the topic, in natural units


class Lyapunov(NamedTuple):
    """Lyapunov exponents of the map from impact to impact, largest first."""

    exponents: np.ndarray  # (4,) [1/tau]; minus infinity where a direction collapses in contact
    std_errors: np.ndarray  # (4,) [1/tau]
    outcome: str  # measured, budget_spent, no_event, search_failed, no_number
    rank: int  # exponents that are finite
    volume_rate: float  # what their sum must be [1/tau]
    duration: float  # measured [tau]
    events: int

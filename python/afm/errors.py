"""What is wrong with an argument."""
from typing import Tuple


class ParameterError(ValueError):
    """One argument: its name, the value given, and why it cannot be used. `faults` holds all that are wrong with a call."""

    faults: Tuple['ParameterError', ...]

    def __init__(self, name: str, value: float, reason: str) -> None:
        super().__init__(name, value, reason)
        self.name, self.value, self.reason = name, value, reason
        self.faults = (self,)

    def __str__(self) -> str:
        return '\n'.join('%s = %.17g: %s' % fault.args for fault in self.faults)

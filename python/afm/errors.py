"""What is wrong with an argument."""
from typing import Any, Tuple


def _text(value: Any) -> str:
    return repr(int(value)) if isinstance(value, float) and value.is_integer() and abs(value) < 1e7 else repr(value)


class ParameterError(ValueError):
    """One argument: its name, the value given, and why it cannot be used. `faults` holds all that are wrong with a
    call."""

    faults: Tuple['ParameterError', ...]

    def __init__(self, name: str, value: Any, reason: str) -> None:
        super().__init__(name, value, reason)
        self.name, self.value, self.reason = name, value, reason
        self.faults = (self,)

    def __str__(self) -> str:
        return '\n'.join('%s = %s: %s' % (fault.name, _text(fault.value), fault.reason) for fault in self.faults)


class ArgumentTypeError(ParameterError, TypeError):
    """An argument of a wrong type."""

"""Arguments of a wrong type: an error that names the argument, in place of pybind11's list of C++ signatures."""
import functools
import math
import operator
import re
from typing import Any, Callable

import numpy as np

from .errors import ArgumentTypeError


def number(name: str, value: Any) -> float:
    """The value as a float."""
    try:
        if isinstance(value, (str, bytes)):  # float() reads these
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise ArgumentTypeError(name, value, 'must be a number') from None
    except OverflowError:  # a whole number beyond all floats: whoever asks has bounds
        return math.inf if value > 0 else -math.inf


def array(name: str, values: Any, reason: str = 'must be numbers') -> np.ndarray:
    """The values as an array of any shape."""
    try:
        given = np.asanyarray(values)  # which keeps a mask
        # a list of nothing has floats; times, texts, booleans and complex numbers are none
        if given.dtype.kind not in 'iuf' or np.ma.is_masked(given):
            raise ValueError
        return np.asarray(given, float)
    except (TypeError, ValueError):
        raise ArgumentTypeError(name, values, reason) from None


def numbers(name: str, values: Any) -> np.ndarray:
    """The values as a one-dimensional array; a number is an array of one."""
    reason = 'must be a number or a one-dimensional array of numbers, one at least'
    one = np.atleast_1d(array(name, values, reason))
    if one.ndim != 1 or not len(one):
        raise ArgumentTypeError(name, values, reason)
    return one


def count(name: str, value: Any, least: int = 0, most: int = 2 ** 31 - 1) -> int:
    """The value as a whole number within these bounds."""
    try:
        whole = operator.index(value) if not isinstance(value, float) or not value.is_integer() else int(value)
    except TypeError:
        raise ArgumentTypeError(name, value, 'must be a whole number, at least %d' % least) from None
    if not least <= whole <= most:
        bounds = 'at least %d' % least if whole < least else 'at most %d' % most
        raise ArgumentTypeError(name, value, 'must be a whole number, ' + bounds)
    return whole


def seed_of(value: Any) -> int:
    return count('seed', value, most=2 ** 64 - 1)


def thread_count(value: Any) -> int:
    return count('threads', value, most=1024)


def _is_a(value, kind):
    return kind in {of.__name__ for of in type(value).__mro__}


def _check(name, kind, value):
    """The value, a whole float as a whole number. kind: as pybind11 writes it, such as typing.SupportsFloat or
    afm._afm.Bath."""
    last = kind.rsplit('.', 1)[-1]
    if last in ('float', 'SupportsFloat'):
        return number(name, value)
    if name == 'threads':
        return thread_count(value)
    if last in ('int', 'SupportsInt', 'SupportsIndex'):
        return count(name, value, least=-2 ** 63 if name == 'i' else 0, most=2 ** 64 - 1)  # an index may be below 0
    if last == 'str' and not isinstance(value, str):
        raise ArgumentTypeError(name, value, 'must be a text')
    if last in ('dict', 'Dict') and not isinstance(value, dict):
        raise ArgumentTypeError(name, value, 'must be a dict')
    if kind.startswith('afm.') and not _is_a(value, last):
        raise ArgumentTypeError(name, value, 'must be a %s' % last)
    if last in ('List', 'list', 'Sequence') and not (isinstance(value, (list, tuple)) and
                                                     all(_is_a(item, 'Tip') for item in value)):
        raise ArgumentTypeError(name, value, 'must be a list of tips')
    return value


def explained(call: Callable, said: str) -> Callable:
    """The function or method, which says which argument is wrong. said: what it is called in errors."""
    signature = (call.__doc__ or '').split('->')[0]
    kinds = dict(re.findall(r'[,(] ?(\w+): ([\w.]+)', signature))
    has_self = kinds.pop('self', None) is not None
    has = '; it has %s' % ', '.join(kinds) if kinds else ''

    @functools.wraps(call)
    def checked(*given, **options):
        try:
            return call(*given, **options)
        except TypeError as fault:
            if 'incompatible' not in str(fault):
                raise
        for name in options if '**' not in signature else ():
            if name not in kinds:
                raise TypeError('%s has no argument %s%s' % (said, name, has))
        taken = [_check(name, kind, value) for (name, kind), value in zip(kinds.items(), given[has_self:])]
        options = {name: _check(name, kinds.get(name, ''), value) for name, value in options.items()}
        try:
            return call(*given[:has_self], *taken, *given[has_self + len(taken):], **options)
        except TypeError as fault:
            if 'incompatible' not in str(fault):
                raise
        raise TypeError('%s lacks an argument, or has one too many%s' % (said, has))
    return checked


def explain(*classes: type) -> None:
    """Lets the constructors, methods and indices of these classes say which argument is wrong."""
    for class_ in classes:
        for name, call in list(vars(class_).items()):
            said = class_.__name__ if name == '__init__' else '%s.%s' % (class_.__name__, name)
            if isinstance(call, staticmethod):
                setattr(class_, name, staticmethod(explained(getattr(class_, name), said)))
            elif type(call).__name__ == 'instancemethod' and (name in ('__init__', '__getitem__') or name[0] != '_'):
                setattr(class_, name, explained(call, said))

"""The tip's path between impacts, from the exact flight (Eq. 9-10)."""
import math

import numpy as np

from . import style

STATE = ("phase", "extension", "u", "w")


def surface(x):
    return style.AMPLITUDE * math.cos(style.TWO_PI * x)


def slope(x):
    """Of the surface, at one place or several."""
    return -style.S * np.sin(style.TWO_PI * x)


def rotated(x, v, frequency, t):
    """Position and velocity of a spring (Eq. 9), its frequency in turns a tau."""
    omega = style.TWO_PI * frequency
    c, s = math.cos(omega * t), math.sin(omega * t)
    return x * c + v * s / omega, v * c - omega * x * s


def at(state, eta, t):
    """Position and velocity in the lab, t after a start at (phase, extension, u, w) in the cell 0."""
    phase, extension, u, w = state
    X, U = rotated(extension, u - eta, style.RATIO, t)
    y, w = rotated(surface(phase), w, 1.0, t)
    return phase + eta * t + X - extension, y, eta + U, w


def flight(state, eta, dt, points=60):
    """x and y of a flight of that duration."""
    return list(zip(*(at(state, eta, dt * i / points)[:2] for i in range(points + 1))))


def next_impact(state, eta, gamma, cutoff, on_error="raise"):
    """The row of the next impact, and the state after it; a state may consist of arrays. on_error: as of the module."""
    import afm  # the other figures do without
    row = afm.next_impact(eta=eta, gamma=gamma, cutoff=cutoff, on_error=on_error, **dict(zip(STATE, state)))[()]
    return row, [row[name + "_next"] for name in STATE]


def flights(start, eta, gamma, cutoff, count):
    """Paths of consecutive flights, each from the cell 0."""
    state, paths = list(start), []
    for _ in range(count):
        row, after = next_impact(state, eta, gamma, cutoff)
        paths.append(flight(state, eta, row["dt"]))
        state = after
    return paths, state


def draw_surface(axes, low, high, bottom=-0.15):
    xs = [low + (high - low) * i / 800 for i in range(801)]
    ys = [surface(x) for x in xs]
    axes.fill_between(xs, ys, bottom, color=style.SOLID)
    axes.plot(xs, ys, color=style.GREY, linewidth=1.2)
    axes.set_xlim(low, high)

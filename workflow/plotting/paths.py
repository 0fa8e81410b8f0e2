"""The tip's path between impacts, from the exact flight (Eq. 9-10)."""
import math

from . import style

STATE = ("phase", "extension", "u", "w")


def surface(x):
    return style.AMPLITUDE * math.cos(style.TWO_PI * x)


def rotated(x, v, frequency, t):
    """Position and velocity of a spring (Eq. 9), its frequency in turns a tau."""
    omega = style.TWO_PI * frequency
    c, s = math.cos(omega * t), math.sin(omega * t)
    return x * c + v * s / omega, v * c - omega * x * s


def flight(state, eta, dt, points=60):
    """x and y of a flight that starts at (phase, extension, u, w)."""
    phase, X, u, w = state
    xs, ys = [], []
    for i in range(points + 1):
        t = dt * i / points
        xs.append(phase + eta * t + rotated(X, u - eta, style.RATIO, t)[0] - X)
        ys.append(rotated(surface(phase), w, 1.0, t)[0])
    return xs, ys


def flights(start, eta, gamma, cutoff, count):
    """Paths of consecutive flights, each from the cell 0."""
    import afm  # the other figures do without
    state, paths = list(start), []
    for _ in range(count):
        row = afm.next_impact(eta=eta, gamma=gamma, cutoff=cutoff, **dict(zip(STATE, state)))[()]
        paths.append(flight(state, eta, row["dt"]))
        state = [row[key + "_next"] for key in STATE]
    return paths, state


def draw_surface(axes, low, high):
    xs = [low + (high - low) * i / 800 for i in range(801)]
    ys = [surface(x) for x in xs]
    axes.fill_between(xs, ys, -0.15, color=style.SOLID)
    axes.plot(xs, ys, color=style.GREY, linewidth=1.2)
    axes.set_xlim(low, high)

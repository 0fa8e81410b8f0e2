#!/usr/bin/env python3
"""The averaged law of chatter as a series (docs/algorithm.md, src/core/contact/chatter_law.h), by computer algebra
(python3-sympy).

One bounce under P(t) and K is a map of the normal speed and of the time. The law is the vector field whose flow, over one
unit of the number of bounces, is that map; it is found order by order. In local units, w for the speed and
2/(loss P) for times, a bounce under a constant pressure lasts w, and

    rho'' = -2 p(s) - K(s) rho,    p = 1 + A s + B s^2/2 + C s^3/6 + ...,    w -> w_i (1 - w_i)

with A = P'/P, B = P''/P, ... and K = 4 K/(loss P)^2 in those units. A takes one w with it, B, K and A^2 two, and so on.

usage: derive_chatter_law.py [ORDER]          all terms of up to that order of w (5: a quarter of a minute)
       derive_chatter_law.py --linear [ORDER] those without B, K, ... and linear in A: the series R, T, S and D
"""

import sys

import sympy as sp

w, A = sp.symbols("w A")
linear = "--linear" in sys.argv
numbers = [int(a) for a in sys.argv[1:] if a.isdigit()]
N = numbers[0] if numbers else (8 if linear else 5)
B, C, D, E, K, K1, K2, K3 = [sp.Integer(0)] * 8 if linear else sp.symbols("B C D E K K1 K2 K3")
most_A = 1 if linear else N


def cut(e, n=N):
    terms = sp.Poly(sp.expand(e), w, A).terms()
    return sum(c * w**k * A**a for (k, a), c in terms if k <= n and a <= most_A)


def powers(s, most):
    """Of s from 0 on, each cut: the whole power would have thousands of terms more."""
    found = [sp.Integer(1)]
    while len(found) <= most:
        found.append(cut(found[-1] * s))
    return found


def bounce():
    """How long it lasts and at what speed it ends, of the speed w at which it begins."""
    p, k = [1, A, B / 2, C / 6, D / 24, E / 120], [K, K1, K2 / 2, K3 / 6]
    rho = [sp.Integer(0), w]  # coefficients of powers of s
    for j in range(N + 3):
        lift = sum(k[i] * rho[j - i] for i in range(min(j + 1, len(k))))
        rho.append(sp.expand((-2 * (p[j] if j < len(p) else 0) - lift) / ((j + 1) * (j + 2))))
    s = w
    for _ in range(N):  # rho/s = 0, in which w - s is the most
        s_to = powers(s, N)
        s = cut(w + sum(cut(rho[j + 1] * s_to[j]) for j in range(2, N + 1)))
    s_to = powers(s, N)
    fall = cut(-sum(cut(j * rho[j] * s_to[j - 1]) for j in range(1, N + 2)))
    return s, fall


def along(f, F, T):
    """The derivative of f along the field: local units change with the pressure."""
    units = [(A, B - 2 * A**2), (B, C - 3 * A * B), (C, D - 4 * A * C), (D, E - 5 * A * D),
             (K, K1 - 2 * A * K), (K1, K2 - 3 * A * K1), (K2, K3 - 4 * A * K2)]
    drift = 0 if linear else sum(sp.diff(f, x) * rate for x, rate in units)
    return cut(sp.diff(f, w) * F) + cut(sp.expand(drift) * T)


def flow(F, T):
    """Speed and time after one bounce of the law dw/dn = F, dt/dn = T."""
    speed, time, f, h, factorial = w, T, w, T, 1
    for j in range(1, N + 1):
        f, factorial = along(f, F, T), factorial * j
        speed += f / factorial
        if j > 1:
            h = cut(along(h, F, T) - T * A * h)
            time += h / factorial
    return cut(speed), cut(time)


s_end, w_incident = bounce()
w_end = cut(w_incident - w_incident**2)
F, T = sp.Integer(0), w
for n in range(2, N + 1):
    F += sp.expand(w_end - flow(F, T)[0]).coeff(w, n) * w**n
    T += sp.expand(s_end - flow(F, T)[1]).coeff(w, n) * w**n

per_T, rest, power = 1, cut(T / w - 1), 1
for _ in range(N):
    power = cut(-power * rest)
    per_T += power
per_T = cut(per_T, N - 1)
change = cut(sp.expand(F / w) * per_T, N - 1)


def show(name, series, last):
    for n in range(last):
        print(f"{name}, w^{n}: {sp.expand(series).coeff(w, n)}")


if linear:
    R, even_T = -sp.expand(change / w).subs(A, 0), per_T.subs(A, 0)
    show("R", R, N - 1)
    show("1/T", even_T, N - 1)
    S = sp.series((1 - 3 * sp.expand(change / w).coeff(A, 1) / even_T) / w**2, w, 0, N - 3).removeO()
    show("S", S, N - 3)
    show("D", sp.series(-6 * per_T.coeff(A, 1) / (w**2 * even_T), w, 0, N - 3).removeO(), N - 3)
else:
    show("a bounce by itself, duration / w", s_end / w, 4)
    show("a bounce by itself, w at its end / w", w_incident / w, 4)
    show("d ln w / dt", sp.expand(change / w), N - 1)
    show("w dn / dt", per_T, N - 1)

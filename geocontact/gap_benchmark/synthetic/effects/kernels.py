"""Loops with memory that injected effects run through, compiled."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop


@loop
def settled(elastic: Float[np.ndarray, "t n"], h: float, tau: float) -> Float[np.ndarray, "t n"]:
    """z' = (F_el - z)/tau by the trapezoidal rule, at rest in the beginning."""
    out = np.empty(elastic.shape)
    out[0] = elastic[0]
    a = 0.5 * h / tau
    for i in range(1, elastic.shape[0]):
        for j in range(elastic.shape[1]):
            out[i, j] = ((1.0 - a) * out[i - 1, j] + a * (elastic[i, j] + elastic[i - 1, j])) / (1.0 + a)
    return out


@loop
def seated(u: Float[np.ndarray, " t"], gap: float) -> Float[np.ndarray, " t"]:
    """How closely a pad sits, 0..1; rate-independent, at first as on the way up."""
    out = np.empty(u.size)
    now = 0.0
    for i in range(u.size):
        rising = min(max((u[i] / gap - 0.9) / 0.4, 0.0), 1.0)
        falling = min(max((u[i] / gap - 0.4) / 0.4, 0.0), 1.0)
        now = min(max(now, rising), falling)
        out[i] = now
    return out


@loop
def hysteresis(u: Float[np.ndarray, " t"], reach: float, n: float, beta: float) -> Float[np.ndarray, " t"]:
    """z of Bouc and Wen along u, rate-independent: Heun's rule in the displacement, steps far below the reach."""
    z = np.zeros(u.size)
    for i in range(1, u.size):
        du = u[i] - u[i - 1]
        pieces = int(abs(du) / (0.05 * reach)) + 1
        step = du / pieces / reach
        now = z[i - 1]
        for _ in range(pieces):
            first = 1.0 - abs(now) ** n * (1.0 - beta + beta * np.sign(step * now))
            guess = now + step * first
            second = 1.0 - abs(guess) ** n * (1.0 - beta + beta * np.sign(step * guess))
            now = now + 0.5 * step * (first + second)
        z[i] = now
    return z


@loop
def pushed(
    on: Float[np.ndarray, " t"], h: float, rising: float, falling: float, growth: float, screw: float
) -> Float[np.ndarray, " t"]:
    """A push over P while a flag is on; each sample's flag holds until the next."""
    out = np.empty(on.size)
    z, since = 0.0, 0.0
    for i in range(on.size):
        out[i] = z * (1.0 + growth * (since / screw - 0.5))
        tau = rising if on[i] > 0.5 else falling
        z += (on[i] - z) * -np.expm1(-h / tau)
        if on[i] > 0.5:
            since = min(since + h, screw)
        elif z < 0.01:
            since = 0.0
    return out


@loop
def slower(phase: float, begin: float) -> float:
    """Rate of primary creep at a phase of the trial, as a share of that at its beginning."""
    return float((begin / (begin + phase)) ** (2.0 / 3.0))


@loop
def crept(
    time: Float[np.ndarray, " t"], u: Float[np.ndarray, " t"], d: float, c: float, m: float, begin: float, whole: float
) -> Float[np.ndarray, " t"]:
    """Deflection left; fourth-order Runge-Kutta, as many steps as keep each far below the stroke `d`."""
    out = np.empty(u.size)
    s = 0.0
    out[0] = u[0]
    k = np.zeros(4)
    for i in range(1, u.size):
        h, du = time[i] - time[i - 1], u[i] - u[i - 1]
        stiffness = c * slower(time[i - 1] / whole, begin) * m / d * max(abs((u[i] - s) / d), 0.05) ** (m - 1.0)
        pieces = int(4.0 * h * stiffness) + 1
        step = h / pieces
        for j in range(pieces):
            for a in range(4):
                part = 0.0 if a == 0 else (1.0 if a == 3 else 0.5)
                gone = s + (part * step * k[a - 1] if a > 0 else 0.0)
                e = (u[i - 1] + du * (j + part) / pieces - gone) / d
                phase = (time[i - 1] + h * (j + part) / pieces) / whole
                k[a] = c * slower(phase, begin) * np.sign(e) * abs(e) ** m
            s += step * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]) / 6.0
        out[i] = u[i] - s
    return out


@loop
def follow(
    u: Float[np.ndarray, " t"], h: float, rising: float, falling: float, corner: float
) -> Float[np.ndarray, " t"]:
    """`u` through a filter that rises and falls differently; by the midpoint rule, in step with a straight line."""
    out = np.empty(u.size)
    lag = 0.5 * (rising + falling)
    slope = (u[1] - u[0]) / h
    y = u[0] - lag * slope
    z, rate = y - slope * np.sqrt(2.0) / corner, slope
    out[0] = z
    for i in range(1, u.size):
        middle = 0.5 * (u[i] + u[i - 1])
        tau = rising if middle > y else falling
        before = y
        y = y + (middle - y) * h / (tau + 0.5 * h)
        # second order: z'' = corner^2 (y - z) - sqrt(2) corner z', trapezoidal
        a = 0.5 * h
        w2 = corner * corner
        damp = np.sqrt(2.0) * corner
        right = rate + a * (w2 * (before + y - 2.0 * z) - damp * rate - w2 * a * rate)
        new = right / (1.0 + a * damp + a * a * w2)
        z = z + a * (rate + new)
        rate = new
        out[i] = z
    return out

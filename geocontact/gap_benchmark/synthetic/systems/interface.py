"""What an interface makes of its deflection, with whatever is hooked in, and how a foot gives way to its load."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values

TOLERANCE = 1e-11
"""Tolerance of what a spring in series gives way by, in the input's unit."""


class NotConvergedError(ArithmeticError):
    """The truth depends on the time step, or an equation was not solved."""


def pull(time: Float[np.ndarray, " t"], u: Values, k: float, hooks: Hooks, dashpot: float = 0.0) -> Values:
    """Force k u + b u' over time, everything hooked in; the dashpot b sees what reaches the spring."""
    u_rate = np.gradient(u, time, edge_order=2)
    attached = u
    for creep in hooks.attachment:
        attached = creep(time, attached, k)
    for slack in hooks.play:
        attached = slack(attached)
    elastic = k * attached
    for factor in hooks.spring:
        elastic = elastic * factor(time, attached, u_rate)
    force = elastic
    if dashpot:
        force = force + dashpot * np.gradient(attached, time, edge_order=2)
    for term in hooks.beside:
        force = force + term(Pull(time, u, u_rate, elastic))
    return force


def in_series(place: Values, pull: Callable[[Values], Values], hooks: Hooks, tolerance: float = TOLERANCE) -> Values:
    """Force where an input gives way to it: damped fixed point on w = g(F(q - w)), asserted to have converged."""
    way = np.zeros_like(place)
    damping = 0.5
    for _ in range(400):
        force = pull(place - way)
        target = sum(give(force) for give in hooks.series)
        if float(np.abs(target - way).max()) < tolerance:
            return force
        way = way + damping * (target - way)
        if not np.isfinite(way).all():
            break
    raise NotConvergedError("a spring in series was not solved")


@loop
def give_way(
    time: Float[np.ndarray, " t"],
    depth: Float[np.ndarray, "t n"],
    closing: Float[np.ndarray, "t n"],
    k: Float[np.ndarray, " n"],
    b: Float[np.ndarray, " n"],
    n: float,
    full: float,
    soft: float,
    hard: float,
    limit: float,
) -> Float[np.ndarray, " t"]:
    """Height w(t) [m] by which the foot gives way to its load through two springs in a row, one of which bottoms out.

    w = hard F + (soft - hard) limit tanh(F / limit). Trapezoidal in w', by bisection.
    """
    way = np.zeros(time.size)
    for i in range(time.size):
        h = time[i] - time[i - 1] if i > 0 else 1.0
        low, high = 0.0, max(depth[i].max(), 0.0)
        for _ in range(60):
            w = 0.5 * (low + high)
            rate = (w - way[i - 1]) / h if i > 0 else 0.0
            force = 0.0
            for j in range(k.size):
                d = depth[i, j] - w
                if d > 0.0:
                    u = min(d / full, 1.0)
                    force += k[j] * d**n + b[j] * max(closing[i, j] - rate, 0.0) * u * u * (3.0 - 2.0 * u)
            if hard * force + (soft - hard) * limit * np.tanh(force / limit) > w:
                low = w
            else:
                high = w
        way[i] = 0.5 * (low + high)
    return way

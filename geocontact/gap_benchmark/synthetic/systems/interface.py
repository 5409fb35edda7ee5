"""What one interface makes of its deflection, with whatever is hooked in; shared by all systems but the foot."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values

TOLERANCE = 1e-11
"""Of what a spring in series gives way by, in the input's unit."""


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

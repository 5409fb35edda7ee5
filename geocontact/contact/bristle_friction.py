"""Friction that sticks: bristles that bend before they slip, a law with memory.

The elastoplastic model of Dupont, Hayward, Armstrong & Altpeter (2002), Single state elastoplastic friction models,
IEEE Trans Autom Control 47, 787-792: the mean deflection s of the bristles follows the motion as long as it is small,
so that what sticks comes back and does not creep, and ends at the largest deflection that friction can hold, where the
bodies slide. The paper turns from one to the other by a sine, here it is 3 e^2 - 2 e^3.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def deflection_rate(deflection: X, speed: X, largest: X, elastic: X) -> X:
    """Derivative of the deflection in time [m/s]: v while |s| < elastic or s goes back, 0 at the largest.

    v - e v |s| / s_max where v and s have the same sign, e rising from 0 to 1 between the two deflections.

    Parameters
    ----------
    deflection
        Of the bristles, s [m].
    speed
        At which the bodies slide on each other, v [m/s], with its sign.
    largest
        Deflection while they slide, s_max = mu N / k [m], > 0.
    elastic
        Part of it up to which nothing slips, 0 to below 1.
    """
    size = np.maximum(deflection, -deflection) / largest
    u = np.minimum(np.maximum((size - elastic) / (1.0 - elastic), 0.0), 1.0)
    slipping = (speed * deflection > 0.0) * (u * u * (3.0 - 2.0 * u))
    rate: X = speed - slipping * speed * size
    return rate


def bristle_force(deflection: X, rate: X, k: X, b: X) -> X:
    """Friction on the body that moves, against the deflection: -(k s + b s') [N].

    Parameters
    ----------
    deflection, rate
        s [m] and its derivative [m/s].
    k, b
        Stiffness [N/m] and damping [N s/m] of the bristles.
    """
    force: X = -(k * deflection + b * rate)
    return force

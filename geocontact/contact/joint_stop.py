"""Stops at the ends of a joint's range: a spring that begins softly, with damping that never pulls.

Beyond the limit by d, F = k r(d) max(1 + a d', 0) with r(d) = d²/(2 w) up to the width w and d - w/2 from there: once
continuously differentiable in d. The factor is that of Hunt & Crossley (1975), Coefficient of restitution interpreted
as damping in vibroimpact, J Appl Mech 42, 440-445: no jump of the force on touching, no pull on leaving.

Scalar in, scalar out: the same source runs on arrays and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def stop_force(value: X, rate: X, lower: X, upper: X, k: X, width: X, damping: X) -> X:
    """Force of both stops along the coordinate, towards the range [N m or N]; 0 within it.

    Parameters
    ----------
    value, rate
        Coordinate [rad, m] and its rate.
    lower, upper
        Ends of the range.
    k
        Stiffness from `width` beyond an end on [N m/rad, N/m].
    width
        Over which the stiffness sets in [rad, m], > 0.
    damping
        a, share of the spring's force that each unit of rate into the stop adds [s/rad, s/m].
    """
    force: X = _pressed(lower - value, -rate, k, width, damping) - _pressed(value - upper, rate, k, width, damping)
    return force


def _pressed(beyond: X, rate: X, k: X, width: X, damping: X) -> X:
    soft = np.minimum(np.maximum(beyond, 0.0), width)
    ramp = soft * soft / (2.0 * width) + np.maximum(beyond - width, 0.0)
    force: X = k * ramp * np.maximum(1.0 + damping * rate, 0.0)
    return force

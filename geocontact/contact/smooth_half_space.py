"""The smooth sphere on a half-space as OpenSim computes it: `SmoothSphereHalfSpaceForce`.

Serrancoli, Falisse, Dembia, Vantilt, Tanghe, Lefeber, Jonkers, De Schutter & De Groote (2019), Subject-exoskeleton
contact model calibration leads to accurate interaction force predictions, IEEE Trans Neural Syst Rehabil Eng 27,
1597-1605; as it became a component of Simbody, whose defaults are the constants below. It differs from the paper's
appendix (`contact.smooth_hunt_crossley`): x^1.5 is (x^2 + 1e-5)^(3/4), there is no slope term, and friction is
another curve with a kink at the transition velocity.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""

CONSTANT = 1e-5
"""Constant contact force of Simbody: added to x^2 [m^2] and to the square of the sliding speed [m^2/s^2]."""
HERTZ_SMOOTHING = 300.0
"""1/m."""
HUNT_CROSSLEY_SMOOTHING = 50.0
"""s/m."""


def half_space_force(depth: X, rate: X, modulus: X, radius: X, c: X, b_d: X, b_v: X, constant: X) -> X:
    """Normal force of OpenSim's smooth sphere [N].

    Parameters
    ----------
    depth, rate
        Indentation [m] and its derivative [m/s].
    modulus
        OpenSim's `stiffness` K [Pa]; what acts is k = K^(2/3) / 2 in (4/3) k sqrt(R k) x^1.5.
    radius
        Of the sphere [m].
    c
        Dissipation [s/m], > 0.
    b_d, b_v
        `hertz_smoothing` [1/m] and `hunt_crossley_smoothing` [s/m].
    constant
        `constant_contact_force`, used as an area [m^2].
    """
    squared = np.sqrt(depth * depth + constant)
    hertz = (4.0 / 3.0) * 2.0**-1.5 * modulus * np.sqrt(radius) * squared * np.sqrt(squared)
    into = 0.5 + 0.5 * np.tanh(b_d * depth)
    together = 0.5 + 0.5 * np.tanh(b_v * (rate + 2.0 / (3.0 * c)))
    force: X = hertz * into * (1.0 + 1.5 * c * rate) * together
    return force


def half_space_coefficient(speed: X, v_t: X, mu_s: X, mu_d: X, mu_v: X) -> X:
    """Tangential over normal force with the sign of `speed`: min(v/v_t, 1) (mu_d + 2 (mu_s - mu_d)/(1 + (v/v_t)^2)).

    To it `mu_v` v is added. Parameters as those of `smooth_hunt_crossley.stribeck_coefficient`. Its first derivative
    jumps at v_t.
    """
    v = speed / v_t
    rising = np.minimum(np.maximum(v, -1.0), 1.0)
    coefficient: X = rising * (mu_d + 2.0 * (mu_s - mu_d) / (1.0 + v * v)) + mu_v * speed
    return coefficient

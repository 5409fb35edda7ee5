"""The keel bent far: the elastica of the overhang on a root that turns, as truth for the hinged keel.

EI theta'' = -F cos(theta) along the arc, theta(0) = r EI theta'(0), theta'(a) = 0: an inextensible cantilever under a
force that keeps its direction, upwards on the tip (Bisshopp & Drucker 1945, Large deflection of cantilever beams,
Q Appl Math 3, 272-275), but with the turn r M of the part behind the fulcrum, which is taken as small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.integrate import solve_bvp

from geocontact.below_knee_prosthesis.keel.beam import root_compliance
from geocontact.below_knee_prosthesis.keel.keel import Keel

POINTS, LEAST = 201, 1e-10
"""Of the shape, and the relative error allowed."""


@dataclass(frozen=True)
class BentKeel:
    """Shape of the overhang.

    Parameters
    ----------
    arc
        Length along the keel from the fulcrum [m].
    turn
        Angle there [rad].
    x, y
        Place in the keel's frame [m].
    """

    arc: Float[np.ndarray, " n"]
    turn: Float[np.ndarray, " n"]
    x: Float[np.ndarray, " n"]
    y: Float[np.ndarray, " n"]


def elastica(keel: Keel, fulcrum: float, force: float) -> BentKeel:
    """Shape under an upward force on the tip [N]; ArithmeticError where none is found."""
    overhang = keel.length - fulcrum
    load = force * overhang**2 / keel.bending
    root = root_compliance(fulcrum, keel.bending, keel.support) * keel.bending / overhang

    def slopes(_: Float[np.ndarray, " n"], v: Float[np.ndarray, "four n"]) -> Float[np.ndarray, "four n"]:
        return np.stack([v[1], -load * np.cos(v[0]), np.cos(v[0]), np.sin(v[0])])

    def ends(a: Float[np.ndarray, " four"], b: Float[np.ndarray, " four"]) -> Float[np.ndarray, " four"]:
        return np.array([a[0] - root * a[1], b[1], a[2], a[3]])

    s = np.linspace(0.0, 1.0, POINTS)
    straight = np.stack([load * (root + s - 0.5 * s**2), load * (1.0 - s), s, load * s**2 / 3.0])
    found = solve_bvp(slopes, ends, s, straight, tol=LEAST, max_nodes=100_000)
    if not found.success:
        raise ArithmeticError(f"no shape of the keel is found under {force:g} N: {found.message}")
    turn, _, x, y = found.sol(s)
    return BentKeel(s * overhang, turn, fulcrum + x * overhang, y * overhang)

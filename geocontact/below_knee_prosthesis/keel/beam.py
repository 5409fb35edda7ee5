"""The keel as a beam: held at its posterior end, propped by a fulcrum, loaded in front of it.

Euler and Bernoulli, small deflections, constant EI. The beam of length L is held at x = 0, may turn but not move at
the fulcrum x = l, and hangs over by a = L - l. A force F at x > l bends the part behind the fulcrum as well, which
turns the beam there by M l/(3 EI) with M = F (x - l) where the end at x = 0 is pinned, by M l/(4 EI) where it is
clamped (Young & Budynas, Roark's Formulas for Stress and Strain, table 8.1). So the tip gives

    F (a² r + a³/(3 EI)),   r = l/(3 EI) pinned, l/(4 EI) clamped

which is F a² L/(3 EI) and F a² (3 l + 4 a)/(12 EI).
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from jaxtyping import Float

Support = Literal["pinned", "clamped"]
SUPPORTS: tuple[Support, ...] = ("pinned", "clamped")
SHARE: dict[Support, float] = {"pinned": 1.0 / 3.0, "clamped": 0.25}
"""Turn at the fulcrum over M l/EI."""


def root_compliance(fulcrum: float, bending: float, support: Support) -> float:
    """Turn of the beam at the fulcrum per moment there, from the part behind it [rad/(N m)].

    Parameters
    ----------
    fulcrum
        l [m].
    bending
        EI [N m²].
    support
        How the posterior end is held.
    """
    return SHARE[support] * fulcrum / bending


def tip_compliance(fulcrum: float, length: float, bending: float, support: Support) -> float:
    """Deflection of the tip per force on it [m/N]; `length` is L [m], the others as for `root_compliance`."""
    overhang = length - fulcrum
    return overhang**2 * root_compliance(fulcrum, bending, support) + overhang**3 / (3.0 * bending)


def deflected(
    x: Float[np.ndarray, " n"], fulcrum: float, length: float, bending: float, support: Support
) -> Float[np.ndarray, " n"]:
    """Deflection at places along the beam per force on the tip [m/N], along the force.

    Behind the fulcrum the beam bows to the other side, at most by 0.064 M l²/EI (pinned) or 0.037 M l²/EI (clamped).
    """
    overhang, moment = length - fulcrum, length - fulcrum
    s = np.clip(x, 0.0, fulcrum) / fulcrum
    bow = (s**3 - s) / 6.0 if support == "pinned" else (s**3 - s**2) / 4.0
    u = np.clip(x - fulcrum, 0.0, None)
    front = root_compliance(fulcrum, bending, support) * moment * u + u**2 * (3.0 * overhang - u) / (6.0 * bending)
    return np.where(x < fulcrum, moment * fulcrum**2 / bending * bow, front)


def compression_stiffness(fulcrum: float, length: float, bending: float, series: float, support: Support) -> float:
    """Force per travel of a plate on the tip [N/m], through what gives besides the keel: sole, pylon, fixture.

    Parameters
    ----------
    series
        Its stiffness [N/m]; infinite for the keel alone.
    """
    return 1.0 / (tip_compliance(fulcrum, length, bending, support) + 1.0 / series)

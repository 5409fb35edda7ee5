"""Bending stiffness along a keel in sections, and what a beam of them gives on two supports.

The stiffness at x is EI times the factor of the section that x is in. The beam is held at x = 0, may turn but not move
at the fulcrum l, and a force acts at L in front of it. By Castigliano the fulcrum turns per moment there by

    r = integral of (x/l)²/EI from 0 to l                                      where the end is pinned
    r = I_tt - I_ts²/I_ss, I_ab the integral of a b/EI, t = x/l, s = 1 - x/l    where it is clamped

(the clamp's moment is that of least energy), and the force's place gives (L - l)² r plus the integral of (L - x)²/EI
from l to L. One section gives the l/(3 EI), l/(4 EI) and (L - l)³/(3 EI) of the books. Integrals are exact: squares of
moments between edges are cubics.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

Support = Literal["pinned", "clamped"]
SUPPORTS: tuple[Support, ...] = ("pinned", "clamped")
SHARE: dict[Support, float] = {"pinned": 1.0 / 3.0, "clamped": 0.25}
"""Turn at the fulcrum over M l/EI of one section."""


@dataclass(frozen=True)
class Sections:
    """Factors on EI along a keel.

    Parameters
    ----------
    edges
        Between sections, from the keel's posterior end [m].
    factors
        Of each section [-]; one more than edges.

    ValueError for edges that do not rise from above 0, factors that are not positive, or another number of them.
    """

    edges: tuple[float, ...] = ()
    factors: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        if len(self.factors) != len(self.edges) + 1:
            raise ValueError(f"{len(self.edges)} edges make {len(self.edges) + 1} sections, not {len(self.factors)}")
        if not (np.diff([0.0, *self.edges]) > 0.0).all() or not (
            np.isfinite(self.factors).all() and min(self.factors) > 0
        ):
            raise ValueError("edges of sections must rise from above 0, and every section needs a positive stiffness")

    @property
    def uniform(self) -> bool:
        """Whether there is one section, of factor 1."""
        return self.factors == (1.0,)

    def at(self, x: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Factor at places [m]; at an edge that of the section behind it."""
        return np.asarray(np.array(self.factors)[np.searchsorted(self.edges, x)])

    def pieces(self, start: float, stop: float) -> Float[np.ndarray, " n"]:
        """Both ends of a stretch [m], and all edges in between."""
        return np.array([start, *(edge for edge in self.edges if start < edge < stop), stop])

    def root_compliance(self, fulcrum: float, bending: float, support: Support) -> float:
        """Turn of the beam at the fulcrum l [m] per moment there, from the part behind it [rad/(N m)].

        `bending` is EI of factor 1 [N m²].
        """
        if self.uniform:
            return SHARE[support] * fulcrum / bending
        ends = self.pieces(0.0, fulcrum) / fulcrum
        falling, mixed, rising = (self._sum(ends * fulcrum, each) for each in _squares(ends))
        share = rising if support == "pinned" else rising - mixed**2 / falling
        return float(share * fulcrum / bending)

    def tip_compliance(self, fulcrum: float, length: float, bending: float, support: Support) -> float:
        """Deflection per force of the place L [m] that it acts on [m/N]."""
        overhang = length - fulcrum
        root = overhang**2 * self.root_compliance(fulcrum, bending, support)
        if self.uniform:
            return root + overhang**3 / (3.0 * bending)
        ends = self.pieces(fulcrum, length)
        return float(root + self._sum(ends, (length - ends[:-1]) ** 3 - (length - ends[1:]) ** 3) / (3.0 * bending))

    def torsional_length(self, fulcrum: float, length: float) -> float:
        """Length of a bar of factor 1 that twists as much as what lies in front of the fulcrum [m]."""
        ends = self.pieces(fulcrum, length)
        return float(self._sum(ends, np.diff(ends)))

    def _sum(self, ends: Float[np.ndarray, " n"], parts: Float[np.ndarray, " m"]) -> float:
        """Sum of integrals between neighbouring places, each over the factor there."""
        return float((parts / self.at(0.5 * (ends[1:] + ends[:-1]))).sum())


def _squares(t: Float[np.ndarray, " n"]) -> tuple[Float[np.ndarray, " m"], ...]:
    """Integrals of (1 - t)², t (1 - t) and t² between neighbouring places."""
    cube, square = np.diff(t**3) / 3.0, np.diff(t**2) / 2.0
    return np.diff(t) - 2.0 * square + cube, square - cube, cube


ONE = Sections()
"""The same stiffness all along."""

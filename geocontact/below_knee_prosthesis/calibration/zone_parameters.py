"""Numbers of the zones of a sole: names, priors, and their place in a law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri

from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.data.parameter import Parameter
from geocontact.loads.sphere_set import SoleLaw

Kind = Literal["stiffness", "damping", "friction"]
KINDS: tuple[Kind, ...] = ("stiffness", "damping", "friction")
UNITS: dict[Kind, str] = {"stiffness": "N/m^n", "damping": "N s/m", "friction": "-"}
PRIOR: dict[Kind, tuple[float, float]] = {"stiffness": (3.0, 12.0), "damping": (10.0, 30.0), "friction": (2.0, 4.0)}
"""Factors, both invented: one standard deviation of the prior, and the bounds of the search."""


@dataclass(frozen=True)
class ZoneParameters:
    """Numbers of the zones of a sole around a usual law: stiffness of all zones, then damping, then friction.

    Friction is the kinetic coefficient; the static one keeps its ratio to it. A zone's number is that of each of its
    spheres. ValueError where a usual number is 0: there is no factor on it.
    """

    sole: KeelSole
    usual: SoleLaw

    def __post_init__(self) -> None:
        if not self.values_of(self.usual).min() > 0.0:
            raise ValueError("the usual law needs damping and friction in every zone")

    @property
    def zones(self) -> tuple[str, ...]:
        """In the order in which they first occur."""
        return tuple(self.sole.spheres.zones)

    @property
    def names(self) -> tuple[str, ...]:
        """Names such as stiffness.forefoot."""
        return tuple(f"{kind}.{zone}" for kind in KINDS for zone in self.zones)

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """Kinds of each number."""
        return tuple(kind for kind in KINDS for _ in self.zones)

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Standard deviation of the prior of the logarithm of each number (`PRIOR`)."""
        return np.log([PRIOR[kind][0] for kind in self.kinds])

    @property
    def reach(self) -> Float[np.ndarray, " p"]:
        """Reach of the logarithm of each number from the usual one to either bound."""
        return np.log([PRIOR[kind][1] for kind in self.kinds])

    def values_of(self, law: SoleLaw) -> Float[np.ndarray, " p"]:
        """The numbers of a law."""
        count = len(self.sole.spheres)
        each = (law.stiffness, law.damping, np.broadcast_to(law.kinetic, count))
        return np.array([column[chosen][0] for column in each for chosen in self.sole.spheres.zones.values()])

    def law(self, values: Float[np.ndarray, " p"]) -> SoleLaw:
        """The usual law with these numbers."""
        stiffness, damping, kinetic = (self.by_sphere(row) for row in values.reshape(3, -1))
        count = len(self.sole.spheres)
        static, usual = (np.broadcast_to(each, count) for each in (self.usual.static, self.usual.kinetic))
        return replace(
            self.usual, stiffness=stiffness, damping=damping, kinetic=kinetic, static=kinetic * static / usual
        )

    def by_sphere(self, values: Float[np.ndarray, " zones"]) -> Float[np.ndarray, " n"]:
        """Number of each sphere's zone."""
        found = np.empty(len(self.sole.spheres))
        for chosen, value in zip(self.sole.spheres.zones.values(), values, strict=True):
            found[chosen] = value
        return found

    def by_name(self, values: Float[np.ndarray, " p"]) -> Mapping[str, float]:
        """The numbers as a table."""
        return dict(zip(self.names, map(float, values), strict=True))

    def parameters(self) -> list[Parameter]:
        """With the bounds of the search."""
        usual = self.values_of(self.usual)
        low, high = usual * np.exp(-self.reach), usual * np.exp(self.reach)
        rows = zip(self.names, self.kinds, usual, low, high, strict=True)
        return [Parameter(name, UNITS[kind], float(v), float(a), float(b)) for name, kind, v, a, b in rows]

    def sd_within(self, intervals: Mapping[str, tuple[float, float]], level: float = 0.95) -> Float[np.ndarray, " p"]:
        """Standard deviation of the logarithm of each number, by the intervals that a calibration found.

        Parameters
        ----------
        intervals
            Lower and upper end by name, both positive; a number that has none keeps its prior (`sd`).
        level
            Probability of the intervals.

        An interval that is wider than the prior's makes no number less known. ValueError, with the name, for one that
        is none.
        """
        found, wide = self.sd, 2.0 * ndtri(0.5 + 0.5 * level)
        for k, name in enumerate(self.names):
            if name in intervals:
                lower, upper = intervals[name]
                if not 0.0 < lower <= upper < np.inf:
                    raise ValueError(f"{name}: {lower:g} to {upper:g} is not an interval")
                found[k] = min(float(np.log(upper / lower) / wide), float(found[k]))
        return found

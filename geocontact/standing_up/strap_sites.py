"""Sites of straps between exoskeleton and person, and numbers of contacts with their bounds and priors.

A mat lies on one leg, both legs are one chain: at thigh and shank two straps act in parallel, and numbers and forces
are those of one of them. The module at the pelvis is one, and mats on it see all of it. All priors are invented.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri

from geocontact.standing_up.worn_device import SHIFT

Vector = Float[np.ndarray, " p"]


@dataclass(frozen=True)
class ContactParameter:
    """A parameter, searched as itself or as the logarithm of its part of the usual value.

    Parameters
    ----------
    name, unit
        As tables call it.
    usual, sd
        Belief beforehand: mean in `unit`, standard deviation of what is searched.
    least, most
        Bounds in `unit`.
    logarithm
        Whether ln(value / usual) is searched.
    """

    name: str
    unit: str
    usual: float
    sd: float
    least: float
    most: float
    logarithm: bool = False

    def searched(self, value: float) -> float:
        """What stands for a value in the search."""
        return float(np.log(value / self.usual)) if self.logarithm else value

    def value(self, searched: float) -> float:
        """In `unit`."""
        return float(self.usual * np.exp(searched)) if self.logarithm else searched


def searched(parameters: Sequence[ContactParameter], values: Sequence[float]) -> Vector:
    """What stands for values in the search."""
    return np.array([each.searched(value) for each, value in zip(parameters, values, strict=True)])


def deviations(
    parameters: Sequence[ContactParameter], intervals: Mapping[str, tuple[float, float]], level: float
) -> Vector:
    """Standard deviations of what is searched, by intervals of a normal distribution; 0 without an interval.

    Parameters
    ----------
    intervals
        Both ends of each, by the parameter's name, in its unit.
    level
        Probability of the intervals.
    """
    reach, sd = 2.0 * float(ndtri(0.5 + 0.5 * level)), np.zeros(len(parameters))
    for k, each in enumerate(parameters):
        if each.name in intervals:
            low, high = (each.searched(end) for end in intervals[each.name])
            sd[k] = (high - low) / reach
    return sd


def usual(parameters: Sequence[ContactParameter]) -> Vector:
    """Where a search starts: at the prior."""
    return searched(parameters, [each.usual for each in parameters])


def bounds(parameters: Sequence[ContactParameter], free: Sequence[str]) -> tuple[Vector, Vector]:
    """Bounds of what is searched; both are the usual value where a parameter is not free. ValueError for a name not
    there.
    """
    unknown = set(free) - {each.name for each in parameters}
    if unknown:
        raise ValueError(f"there is no parameter {min(unknown)!r}")
    low, high = (
        searched(parameters, [getattr(p, side) if p.name in free else p.usual for p in parameters])
        for side in ("least", "most")
    )
    return low, high


LEGS, MODULES = 2, 1
"""Straps in parallel at thigh and shank, and at the pelvis."""
DAMPING, TURNING_DAMPING = 10.0, 0.1
"""Damping of one strap [N s/m], [N m s/rad]: the study's, held."""
SPRINGS = ("normal", "tangential", "turning")


@dataclass(frozen=True)
class StrapSite:
    """One place of the body.

    Parameters
    ----------
    person, device
        Bodies of both chains.
    hinges
        How many hinges of either chain lie between the foot and these bodies.
    above
        Height of the exoskeleton's hinge below over the person's [m]: the strap is so much nearer to it.
    count
        Straps in parallel between the chains.
    parameters
        Of one strap: stiffness across the segment, along it and in turning, and its distance from the person's hinge.
    damping, turning_damping
        Of one strap's dashpots [N s/m], [N m s/rad].
    """

    name: str
    person: str
    device: str
    hinges: int
    above: float
    count: int
    parameters: tuple[ContactParameter, ...]
    damping: float = DAMPING
    turning_damping: float = TURNING_DAMPING

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(each.name for each in self.parameters)


def _parameters(prefix: str, place: tuple[float, float, float, float]) -> tuple[ContactParameter, ...]:
    """Springs alike everywhere, and a place that is usual, its standard deviation and its bounds [m]."""
    names = [f"{prefix}strap {each}" for each in (*SPRINGS, "place")]
    return (
        ContactParameter(names[0], "N/m", 3e3, 1.0, 1e2, 1e5, logarithm=True),
        ContactParameter(names[1], "N/m", 3e3, 1.0, 1e2, 1e5, logarithm=True),
        ContactParameter(names[2], "N m/rad", 20.0, 1.0, 0.5, 1e3, logarithm=True),
        ContactParameter(names[3], "m", *place),
    )


THIGH_STRAP = StrapSite("thigh", "thigh", "exo_thigh", 2, SHIFT, LEGS, _parameters("", (0.2, 0.03, 0.05, 0.38)))
SHANK_STRAP = StrapSite("shank", "shank", "exo_shank", 1, 0.0, LEGS, _parameters("shank ", (0.25, 0.03, 0.05, 0.42)))
PELVIS_STRAP = StrapSite(
    "pelvis", "trunk", "exo_module", 3, 0.0, MODULES, _parameters("pelvis ", (0.1, 0.03, -0.05, 0.25))
)
"""Strap of the trunk, which stands for the pelvis too."""
STRAP_SITES = (THIGH_STRAP, SHANK_STRAP, PELVIS_STRAP)
"""The first is always there; in this order the normal forces of a trial and of a model stand."""


def sites_of(values: Collection[str]) -> tuple[StrapSite, ...]:
    """Those whose parameters are among names."""
    return tuple(each for each in STRAP_SITES if each.names[0] in values)


def strap_sites(names: tuple[str, ...]) -> tuple[StrapSite, ...]:
    """Those that are named and the first."""
    return tuple(each for k, each in enumerate(STRAP_SITES) if not k or each.name in names)

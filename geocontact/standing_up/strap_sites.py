"""Where an exoskeleton is strapped to a person: thigh, shank and pelvis, and what is believed of each strap.

A mat lies on one leg, both legs are one chain: at thigh and shank two straps act in parallel, and numbers and forces
are those of one of them. The module at the pelvis is one, and mats on it see all of it. All that is believed is
invented.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from geocontact.standing_up.contact_parameter import ContactParameter

LEGS, MODULES = 2, 1
"""Straps in parallel at thigh and shank, and at the pelvis."""
DAMPING, TURNING_DAMPING = 10.0, 0.1
"""Of one strap [N s/m], [N m s/rad]: the study's, held."""
SHIFT = 0.01
"""The exoskeleton's knee above the person's [m]."""
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
    higher
        Whether the exoskeleton's hinge below is higher than the person's, as its knee is.
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
    higher: bool
    count: int
    parameters: tuple[ContactParameter, ...]
    damping: float = DAMPING
    turning_damping: float = TURNING_DAMPING

    @property
    def above(self) -> float:
        """Height of the exoskeleton's hinge over the person's [m]: the strap is so much nearer to it."""
        return SHIFT if self.higher else 0.0

    @property
    def names(self) -> tuple[str, ...]:
        """Of the parameters."""
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


THIGH_STRAP = StrapSite("thigh", "thigh", "exo_thigh", 2, True, LEGS, _parameters("", (0.2, 0.03, 0.05, 0.38)))
SHANK_STRAP = StrapSite("shank", "shank", "exo_shank", 1, False, LEGS, _parameters("shank ", (0.25, 0.03, 0.05, 0.42)))
PELVIS_STRAP = StrapSite(
    "pelvis", "trunk", "exo_module", 3, False, MODULES, _parameters("pelvis ", (0.1, 0.03, -0.05, 0.25))
)
"""Of the trunk, which stands for the pelvis too."""
STRAP_SITES = (THIGH_STRAP, SHANK_STRAP, PELVIS_STRAP)
"""The first is always there; in this order the normal forces of a trial and of a model stand."""


def sites_of(values: Collection[str]) -> tuple[StrapSite, ...]:
    """Those whose parameters are among names."""
    return tuple(each for each in STRAP_SITES if each.names[0] in values)


def strap_sites(names: tuple[str, ...]) -> tuple[StrapSite, ...]:
    """Those that are named and the first."""
    return tuple(each for k, each in enumerate(STRAP_SITES) if not k or each.name in names)

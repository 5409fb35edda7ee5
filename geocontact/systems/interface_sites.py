"""Where an exoskeleton is strapped to the body: one deflection per site, u = normal + ρ rotation.

Each site has a spring, a dashpot and a memory of its own; sites do not feel each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.implicit import require_convergence
from geocontact.chain.links import Law, Loads, Values
from geocontact.chain.movement import Movement
from geocontact.chain.single_deflection import along, in_series
from geocontact.chain.slots import Slots, Source
from geocontact.geometry.kernels.compile import kernel

SITE_GEOMETRY = Slots(
    {
        "rho": 0.0,
        "axis_migration.slope": 0.0,
        "axis_migration.curvature": 0.0,
        "axis_migration.centre": 0.0,
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
    }
)
"""Numbers of one site in the order in which the kernels read them."""
COMPLIANCE = 4


@kernel
def deflected(
    normal: Float[np.ndarray, "s t"],
    turn: Float[np.ndarray, "s t"],
    closing: Float[np.ndarray, "s t"],
    spin: Float[np.ndarray, "s t"],
    numbers: Float[np.ndarray, "s seven"],
) -> tuple[Float[np.ndarray, "s t"], Float[np.ndarray, "s t"]]:
    """u = normal + ρ φ and its rate, ρ = ρ0 + a ψ + c ψ², ψ the rotation φ from the middle of its range."""
    u, rate = np.empty(normal.shape), np.empty(normal.shape)
    for s in range(normal.shape[0]):
        rho0, slope, bend, centre = numbers[s, 0], numbers[s, 1], numbers[s, 2], numbers[s, 3]
        for i in range(normal.shape[1]):
            angle = turn[s, i] - centre
            rho = rho0 + angle * (slope + bend * angle)
            u[s, i] = normal[s, i] + rho * turn[s, i]
            rate[s, i] = closing[s, i] + spin[s, i] * (rho + turn[s, i] * (slope + 2.0 * bend * angle))
    return u, rate


@kernel
def carried(
    time: Float[np.ndarray, " t"],
    u: Float[np.ndarray, "s t"],
    rate: Float[np.ndarray, "s t"],
    numbers: Float[np.ndarray, "s seven"],
    law: Float[np.ndarray, "s numbers"],
) -> tuple[Float[np.ndarray, "t s"], int]:
    """Load of every site, and how many samples have no solution behind a spring in series."""
    out = np.empty((u.shape[1], u.shape[0]))
    straight = np.array([[0.0, 1.0], [0.0, 1.0], [1.0, 1.0]])
    unsolved = 0
    for s in range(u.shape[0]):
        if numbers[s, COMPLIANCE] == 0.0:
            out[:, s] = along(time, u[s], rate[s], law[s])
        else:
            out[:, s], missed = in_series(time, u[s], rate[s], straight, numbers[s, COMPLIANCE:], law[s])
            unsolved += missed
    return out, unsolved


@dataclass(frozen=True)
class InterfaceSites:
    """Geometry link: at each site the exoskeleton moves against the body along the normal and about the attachment.

    Parameters
    ----------
    sites
        Names that the channels begin with ("thigh_normal").
    slots
        Numbers of all sites, "thigh.rho"; of a single one without its name.
    """

    sites: tuple[str, ...]
    slots: Slots

    @property
    def yields(self) -> str:
        """What gives way to a spring in series: the normal displacement, here that of the first site."""
        return f"{self.sites[0]}_normal"

    def having(self, sources: Mapping[str, Source]) -> InterfaceSites:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def at(self, place: str) -> InterfaceSites:
        """One site alone."""
        return InterfaceSites((place,), self.slots.at(place))

    def deflection(
        self, movement: Movement, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """u [m] and u' [m/s] of each site, nothing giving way."""
        u, rate = self._deflected(movement, self._numbers(values))
        return u.T, rate.T

    def loads(self, movement: Movement, law: Law, values: Values) -> Loads:
        """Force of each site along a movement, each with a memory of its own."""
        numbers = self._numbers(values)
        u, rate = self._deflected(movement, numbers)
        of_law = law.slots.numbers(values).reshape(len(self.sites), -1)
        normal, unsolved = carried(movement.time, u, rate, numbers, of_law)
        require_convergence(unsolved, normal.size, numbers[:, COMPLIANCE].max())
        nothing = np.zeros_like(normal)
        return Loads(normal, nothing, nothing)

    def _numbers(self, values: Values) -> Float[np.ndarray, "s seven"]:
        return self.slots.numbers(values).reshape(len(self.sites), -1)

    def _deflected(
        self, movement: Movement, numbers: Float[np.ndarray, "s seven"]
    ) -> tuple[Float[np.ndarray, "s t"], Float[np.ndarray, "s t"]]:
        along_normal, about = (
            [movement.row(f"{site}_{motion}") for site in self.sites] for motion in ("normal", "rotation")
        )
        place, rate = movement.position, movement.rate
        return deflected(place[along_normal], place[about], rate[along_normal], rate[about], numbers)

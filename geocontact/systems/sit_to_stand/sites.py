"""Where an exoskeleton is strapped to the body: one deflection per site, u = normal + ρ rotation.

Each site has a spring, a dashpot and a memory of its own; sites do not feel each other.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.implicit import require_convergence
from geocontact.chain.known_deflection import along, known_changes
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.links import Law, Loads, Values
from geocontact.chain.single_deflection import in_series
from geocontact.geometry.kernels.compile import kernel

SITE_GEOMETRY = LawParameters(
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
    position: Float[np.ndarray, "i t"],
    speed: Float[np.ndarray, "i t"],
    rows: Int[np.ndarray, "s two"],
    numbers: Float[np.ndarray, "s seven"],
) -> tuple[Float[np.ndarray, "s t"], Float[np.ndarray, "s t"]]:
    """u = normal + ρ φ and its rate, ρ = ρ0 + a ψ + c ψ², ψ the rotation φ from the middle of its range.

    `rows` are those of the normal displacement and of the rotation of each site.
    """
    u, rate = np.empty((len(rows), position.shape[1])), np.empty((len(rows), position.shape[1]))
    for s in range(len(rows)):
        rho0, slope, bend, centre = numbers[s, 0], numbers[s, 1], numbers[s, 2], numbers[s, 3]
        normal, rotation = rows[s, 0], rows[s, 1]
        for i in range(position.shape[1]):
            turn = position[rotation, i]
            angle = turn - centre
            rho = rho0 + angle * (slope + bend * angle)
            u[s, i] = position[normal, i] + rho * turn
            rate[s, i] = speed[normal, i] + speed[rotation, i] * (rho + turn * (slope + 2.0 * bend * angle))
    return u, rate


@kernel
def carried(
    time: Float[np.ndarray, " t"],
    position: Float[np.ndarray, "i t"],
    speed: Float[np.ndarray, "i t"],
    rows: Int[np.ndarray, "s two"],
    numbers: Float[np.ndarray, "s seven"],
    law: Float[np.ndarray, "s numbers"],
) -> tuple[Float[np.ndarray, "t s"], int]:
    """Load of every site, and how many samples have no solution behind a spring in series."""
    u, rate = deflected(position, speed, rows, numbers)
    out = np.empty((time.size, len(rows)))
    straight = np.array([[0.0, 1.0], [0.0, 1.0], [1.0, 1.0]])
    unsolved = 0
    for s in range(len(rows)):
        if numbers[s, COMPLIANCE] == 0.0:
            out[:, s] = along(time, u[s], rate[s], law[s])
        else:
            out[:, s], missed = in_series(time, u[s], rate[s], straight, numbers[s, COMPLIANCE:], law[s])
            unsolved += missed
    return out, unsolved


@functools.lru_cache(maxsize=32)
def rows_of(sites: tuple[str, ...], inputs: tuple[str, ...]) -> Int[np.ndarray, "s two"]:
    """Places of the normal displacement and of the rotation of each site among the inputs."""
    return np.array([[inputs.index(f"{site}_{motion}") for motion in ("normal", "rotation")] for site in sites])


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
    slots: LawParameters

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
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """u [m] and u' [m/s] of each site, nothing giving way."""
        rows = rows_of(self.sites, movement.inputs)
        u, rate = deflected(movement.position, movement.rate, rows, self._numbers(values))
        return u.T, rate.T

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force of each site along a movement, each with a memory of its own."""
        numbers, rows = self._numbers(values), rows_of(self.sites, movement.inputs)
        of_law = law.slots.numbers(values).reshape(len(self.sites), -1)
        normal, unsolved = carried(movement.time, movement.position, movement.rate, rows, numbers, of_law)
        require_convergence(unsolved, normal.size, numbers[:, COMPLIANCE].max())
        nothing = np.zeros_like(normal)
        return Loads(normal, nothing, nothing)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.tangents`)."""
        return known_changes(self, movement, law, values, others)

    def _numbers(self, values: Values) -> Float[np.ndarray, "s seven"]:
        return self.slots.numbers(values).reshape(len(self.sites), -1)

"""Geometry of the elbow's chain: deflection of the attachment, with a spring in series where there is one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.deflection import ELBOW_GEOMETRY, deflect, misalignment
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.implicit import ATTEMPTS, TOLERANCE, next_load, nothing_known, require_convergence, start_over
from geocontact.chain.interface_law import MEMORY, interface_force
from geocontact.chain.known_deflection import known_changes
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.links import Law, Loads, Values
from geocontact.geometry.kernels.compile import kernel


@kernel
def gives_way(force: float, n: Float[np.ndarray, " slots"]) -> float:
    """Angle by which a spring in series gives way to `force` [rad]."""
    share = force / n[9]
    return float(n[7] * n[9] * (share if n[8] == 1.0 else np.sign(share) * abs(share) ** n[8]))


@kernel
def carry(
    time: Float[np.ndarray, " t"],
    beta: Float[np.ndarray, " t"],
    rate: Float[np.ndarray, " t"],
    n: Float[np.ndarray, " slots"],
    law: Float[np.ndarray, " numbers"],
) -> tuple[Float[np.ndarray, " t"], int]:
    """Force of every sample [N] and how many of them have no solution.

    With a spring in series, β - c F(β) is what deflects: one implicit equation per sample, the spring's rate being
    its change over the step (first order in the step, where the law depends on the rate).
    """
    force = np.empty(beta.size)
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    search = nothing_known()
    unsolved = 0
    before = 0.0
    for i in range(beta.size):
        h = time[i] - time[i - 1] if i else 0.0
        u, v = misalignment(beta[i], rate[i], n)
        found = interface_force(u, v, h, law, old, new)
        if n[7] != 0.0:
            start_over(search)
            guess = 2.0 * force[i - 1] - force[i - 2] if i > 1 else found
            solved = False
            for _ in range(ATTEMPTS):
                given = gives_way(guess, n)
                speed = rate[i] - (given - before) / h if i else rate[i]
                u, v = misalignment(beta[i] - given, speed, n)
                found = interface_force(u, v, h, law, old, new)
                solved = abs(guess - found) <= TOLERANCE * max(abs(found), n[9])
                if solved:
                    break
                guess = next_load(guess, guess - found, search)
            unsolved += not solved
            before = gives_way(found, n)
        force[i] = found
        old, new = new, old
    return force, unsolved


@dataclass(frozen=True)
class ElbowMisalignment:
    """Geometry link of the elbow: input beta, one deflection."""

    slots: LawParameters = ELBOW_GEOMETRY

    @property
    def yields(self) -> str:
        """Input that gives way to a spring in series."""
        return "beta"

    def having(self, sources: Mapping[str, Source]) -> ElbowMisalignment:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """Deflection [m] and rate [m/s] without load."""
        row = movement.row("beta")
        value, rate = deflect(movement.position[row], movement.rate[row], self.slots.numbers(values))
        return value[:, None], rate[:, None]

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force along a movement."""
        row = movement.row("beta")
        n = self.slots.numbers(values)
        force, unsolved = carry(movement.time, movement.position[row], movement.rate[row], n, law.slots.numbers(values))
        require_convergence(unsolved, len(force), n[7])
        column = force[:, None]
        nothing = np.zeros_like(column)
        return Loads(column, nothing, nothing)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.tangents`)."""
        return known_changes(self, movement, law, values, others)

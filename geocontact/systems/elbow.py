"""Elbow exoskeleton: force at the attachment from a misaligned axis, F = k d_tot (explicit model), and its geometry.

Input `beta [rad]`, output `force [N]`; parameters k, x, y; l and z are constants or fixed parameters.
(k, x, y, l, z) together are not identifiable from any data: F(k/s, s × lengths) = F.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.axis_misalignment.explicit import ELBOW_GEOMETRY, deflect, misalignment
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW, MEMORY, interface_force
from geocontact.chain.links import Balance, Law, LawParameters, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import known_changes
from geocontact.chain.system import (
    ATTEMPTS,
    TOLERANCE,
    System,
    next_load,
    nothing_known,
    require_convergence,
    start_over,
)
from geocontact.chain.traits import Mass, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.geometry.kernels.compile import kernel
from geocontact.systems.base import Base, CaseNeeds, require_numbers


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
        """Forces along a movement, and how they change towards other values (`chain.system`)."""
        return known_changes(self, movement, law, values, others, by_slots=True)


INPUTS, OUTPUTS = ("beta",), ("force",)
UNITS = {"beta": "rad", "force": "N"}
LENGTHS = ("l", "z", "x", "y")
FORMER = {"l_ex": "l", "z_ex": "z"}
"""Names of an earlier version, which cases may still use."""
ABSENT = ("contact_loss.opening", "asymmetry.excess")
"""Terms of the law that a cuff around the arm does not have: it holds to both sides, alike."""
TRAITS = Traits(way=Way(0.4, "unit"), masses=(Mass("tip", ("beta",), "l"), Mass("attachment")))
"""A spring in series turns by 0.4 rad at the most; a mass may sit at the end of the link, or move with the cuff."""


def measured_force(loads: Loads) -> Float[np.ndarray, "t c"]:
    """The one load is the output."""
    return loads.normal.copy()


NUMBERS = {**dict.fromkeys(LENGTHS, "m"), "k": "N/m"}
NEEDS = CaseNeeds("exoskeleton on a misaligned axis", UNITS, lambda _channels, _tables: NUMBERS)


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    parameters = tuple(replace(each, name=FORMER.get(each.name, each.name)) for each in parameters)
    constants = {FORMER.get(name, name): value for name, value in constants.items()}
    require_numbers("elbow", tuple(NUMBERS), parameters, constants, positive=("k", "l"))
    return System(
        name="elbow",
        motion=Motion(INPUTS),
        geometry=ElbowMisalignment().having({name: name for name in LENGTHS}),
        law=Law(INTERFACE_LAW).having({"k": "k"}).lacking(*ABSENT),
        balance=Balance(OUTPUTS, measured_force),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        lengths=tuple(name for name in LENGTHS if name in constants),
        traits=TRAITS,
    )


ELBOW = Base("elbow", INPUTS, OUTPUTS, build, needs=NEEDS)

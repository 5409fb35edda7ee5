"""A channel in a wrong unit: every trial, or some only.

A measured channel reads `factor` times what it should; the factor is one of those that mix-ups of units have. Outputs
are multiplied by it; an input that reads too much is divided by it before the model sees it. No parameter: discrete.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import degrees

import numpy as np

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Values
from geocontact.chain.system import System
from geocontact.effects.data_errors.data_error import MIX_UP, input_error, output_error

FACTORS = {
    "N": (1000.0, 9.80665, 4.4482216152605),
    "N m": (1000.0, 9.80665, 0.1129848290276167),
    "m": (1000.0, 100.0, 0.0254),
    "m^2": (1e6, 1e4),
    "rad": (degrees(1.0),),
}
"""What the units of a dimension differ by: kN, kgf, lbf; kN m, kgf m, lbf in; mm, cm, inch; mm^2, cm^2; degrees.

Their inverses count as well.
"""


def factors(unit: str) -> dict[str, float]:
    """Factors by name, "1000" and "1 over 1000"."""
    found: dict[str, float] = {}
    for factor in FACTORS.get(unit, ()):
        found |= {f"{factor:.5g}": factor, f"1_over_{factor:.5g}": 1.0 / factor}
    return found


def output_times(column: int, factor: float) -> Callable[[Channels, DifferentiatedInputs, Values], Channels]:
    """Multiplies a column."""

    def change(outputs: Channels, _: DifferentiatedInputs, __: Values) -> Channels:
        out = outputs.copy()
        out[:, column] *= factor
        return out

    return change


def input_over(
    row: int, factor: float
) -> Callable[[DifferentiatedInputs, DifferentiatedInputs, Values], DifferentiatedInputs]:
    """Divides an input and its derivatives."""

    def change(movement: DifferentiatedInputs, _: DifferentiatedInputs, __: Values) -> DifferentiatedInputs:
        by = np.ones((len(movement.inputs), 1))
        by[row] = 1.0 / factor
        return replace(
            movement,
            position=movement.position * by,
            rate=movement.rate * by,
            acceleration=movement.acceleration * by,
        )

    return change


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per channel and factor."""
    found = [
        output_error("unit_error", f"{name}.{word}", MIX_UP, output_times(column, factor), name, factor)
        for column, name in enumerate(system.outputs)
        for word, factor in factors(system.unit(name)).items()
    ]
    found += [
        input_error("unit_error", f"{name}.{word}", input_over(system.inputs.index(name), factor), name, factor)
        for name in system.driving
        for word, factor in factors(system.unit(name)).items()
    ]
    return tuple(found)


UNIT_ERROR = Effect(
    "unit_error",
    "data",
    offer,
    "NIST SP 811, conversion factors",
)

"""What the tests of effects do with a candidate."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from tests.systems.examples import NAMES, example

EXAMPLES = {name: example(name) for name in NAMES}


def stands_for_others(system: System, one: Candidate) -> bool:
    """Whether a candidate is tried: of several places of contact, which are alike, the first and what joins it."""
    first, *others = system.places or ("",)
    return not any(place in one.label for place in others) or first in one.label


OFFERED = [
    (name, one) for name in NAMES for one in candidates(EXAMPLES[name][0]) if stands_for_others(EXAMPLES[name][0], one)
]
FITTED = [(name, one) for name, one in OFFERED if one.parameters]
DISCRETE = [(name, one) for name, one in OFFERED if not one.parameters]


def label(value: object) -> str:
    return value.label if isinstance(value, Candidate) else str(value)


def truth(one: Candidate) -> dict[str, float]:
    """Values away from every start and every bound."""
    amplitude, *shapes = one.parameters
    found = {amplitude.name: 1.3 * amplitude.start}
    if one.name == "saturation":
        found[amplitude.name] = 0.77 * amplitude.start
    for shape in shapes:
        towards = shape.upper if shape.upper - shape.start >= shape.start - shape.lower else shape.lower
        found[shape.name] = shape.start + 0.13 * (towards - shape.start)
    return found


def outputs(system: System, trials: tuple[Trial, ...], values: Mapping[str, float]) -> np.ndarray:
    return np.concatenate([system.simulate(trial, values) for trial in trials])


def in_units_of_scale(system: System, table: np.ndarray) -> np.ndarray:
    return table / [system.scale.of(name) for name in system.outputs]


def difference(system: System, a: np.ndarray, b: np.ndarray) -> float:
    """Root mean square of what both have values for, every channel over its magnitude."""
    return float(np.sqrt(np.nanmean(in_units_of_scale(system, a - b) ** 2)))

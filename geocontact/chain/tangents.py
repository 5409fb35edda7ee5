"""Derivatives of a system's outputs by its parameters, where its geometry knows those of the loads.

Loads take nearly all of the time of a simulation. Their changes along all parameters are had at once, exact; balance
and sensor, which are cheap, are read a second time with loads and parameters so little further on that differences
show the derivative to seven digits. A balance sums loads of one sample, its modifiers what they like.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.implicit import NotConverged
from geocontact.chain.law_parameters import LawParameters
from geocontact.chain.links import Law, Loads, Values, passed_on
from geocontact.chain.system import System
from geocontact.data.trial import Trial


@runtime_checkable
class DifferentiatedLoads(Protocol):
    """A geometry that knows how its loads change with the numbers of law and geometry."""

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Loads along a movement, and to first order what is more of them at other values close by.

        None for others that change a number whose derivative is not known, and in the place of all where the law or
        the geometry itself has none.
        """


def towards(slots: LawParameters, values: Values, others: Sequence[Values]) -> Float[np.ndarray, "q slots"]:
    """How far each number is further on at other values."""
    own = slots.numbers(values)
    found = np.zeros((len(others), own.size))
    for row, other in zip(found, others, strict=True):
        numbers = slots.numbers(other)
        differ = numbers != own
        row[differ] = numbers[differ] - own[differ]
    return found


def tangents(
    system: System, trial: Trial, values: Mapping[str, float], steps: Mapping[str, float]
) -> dict[str, Float[np.ndarray, "t c"]]:
    """Derivative of the outputs by each parameter in `steps`, which says how far on it is looked; without those that
    are not known. 0 where the model has no value.
    """
    geometry, motion = system.geometry, system.motion
    if not isinstance(geometry, DifferentiatedLoads):
        return {}
    numbers = {**trial.covariates, **system.known, **values}
    movement = motion.seen(trial, numbers)
    others = {name: {**numbers, name: numbers[name] + by} for name, by in steps.items()}
    if motion.modifiers:
        others = {name: other for name, other in others.items() if _same(movement, motion.seen(trial, other))}
    try:
        found = geometry.changes(movement, system.law, numbers, list(others.values()))
    except NotConverged:
        return {}
    if found is None:
        return {}
    loads, ways = found
    known = {name: more for name, more in zip(others, ways, strict=True) if more is not None}
    totals = system.balance.total(_stacked(loads, list(known.values())))
    before, *after = (
        system.sensor.read(passed_on(system.balance.modifiers, total, movement, own), movement, own)
        for total, own in zip(
            totals.reshape(1 + len(known), len(movement.time), -1),
            (numbers, *(others[name] for name in known)),
            strict=True,
        )
    )
    slopes = {}
    for name, own in zip(known, after, strict=True):
        change = (own - before) / steps[name]
        slopes[name] = np.where(np.isfinite(change), change, 0.0)
    return slopes


def _same(one: DifferentiatedInputs, other: DifferentiatedInputs) -> bool:
    arrays = ((one.position, other.position), (one.rate, other.rate), (one.acceleration, other.acceleration))
    return all(a is b or np.array_equal(a, b, equal_nan=True) for a, b in arrays)


def _stacked(loads: Loads, changes: Sequence[Loads]) -> Loads:
    """Loads, and below them loads with each change, for a balance that takes every sample by itself.

    Where loads act stays.
    """

    def below(own: Float[np.ndarray, "t n"], more: Sequence[Float[np.ndarray, "t n"]]) -> Float[np.ndarray, "m n"]:
        return np.concatenate([own, *(own + each for each in more)])

    return Loads(
        below(loads.normal, [each.normal for each in changes]),
        below(loads.tangential, [each.tangential for each in changes]),
        np.tile(loads.arm, (1 + len(changes), 1)),
        below(loads.moved, [each.moved for each in changes]),
    )

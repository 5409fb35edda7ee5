"""Who records a scene: with what, how far things sit elsewhere in every trial, and sensors that warm up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.recording import AT_ONCE, EXACT, USUAL, Clock, Recorder, Sampler

Outputs = Float[np.ndarray, "c t"]


@dataclass(frozen=True)
class Placement:
    """How far things are off in one trial; or, for all trials of a case, by how much on average (standard deviation).

    Parameters
    ----------
    constants
        What is added to a constant, by name.
    inputs
        What the true motion is ahead of what is measured, by row.
    gains, zeros
        Of outputs, by row: measured is (1 + gain) true + zero.
    """

    constants: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[int, float] = field(default_factory=dict)
    gains: Mapping[int, float] = field(default_factory=dict)
    zeros: Mapping[int, float] = field(default_factory=dict)

    def __len__(self) -> int:
        return sum(len(one) for one in self._parts.values())

    def __add__(self, other: Placement) -> Placement:
        """Off by both; self where the other is nothing."""
        if not len(other):
            return self
        parts = other._parts
        return Placement(**{part: _sum(one, parts[part]) for part, one in self._parts.items()})

    def drawn(self, rng: np.random.Generator) -> Placement:
        """Placements of one trial, these being standard deviations."""
        return self.times(rng.standard_normal(len(self)))

    def each(self) -> Iterator[Placement]:
        """Every single deviation alone."""
        yield from (self.times(one) for one in np.eye(len(self)))

    def opposite(self) -> Placement:
        """The same amplitude to the other side."""
        return self.times(np.full(len(self), -1.0))

    def moved(self, course: InputCourse) -> InputCourse:
        """The true motion."""
        if not self.inputs:
            return course
        position = course.position.copy()
        for row, by in self.inputs.items():
            position[row] += by
        return replace(course, position=position)

    def shifted(self, constants: Mapping[str, float]) -> Mapping[str, float]:
        """The true constants."""
        return {**constants, **{name: constants[name] + by for name, by in self.constants.items()}}

    def measured(self, outputs: Outputs) -> Outputs:
        """What the sensors give for the true outputs."""
        out = outputs.copy()
        for row, gain in self.gains.items():
            out[row] *= 1.0 + gain
        for row, by in self.zeros.items():
            out[row] += by
        return out

    def times(self, factors: Float[np.ndarray, " q"]) -> Placement:
        """Each multiplied by a factor, in the order of the fields."""
        left = iter(factors.tolist())
        return Placement(
            **{part: {key: by * next(left) for key, by in one.items()} for part, one in self._parts.items()}
        )

    @property
    def _parts(self) -> dict[str, Mapping[Any, float]]:
        return {"constants": self.constants, "inputs": self.inputs, "gains": self.gains, "zeros": self.zeros}


def _sum(one: Mapping[Any, float], other: Mapping[Any, float]) -> dict[Any, float]:
    return {key: one.get(key, 0.0) + other.get(key, 0.0) for key in {**one, **other}}


IN_PLACE = Placement()
"""Nothing is off."""


@dataclass(frozen=True)
class WarmUp:
    """Off by `cold` exp(-turn/`trials`) in the trial of number `turn`."""

    cold: Placement = IN_PLACE
    trials: float = 1.0

    def at(self, turn: int) -> Placement:
        """What is left in a trial."""
        return self.cold.times(np.full(len(self.cold), np.exp(-turn / self.trials)))


WARM = WarmUp()
"""Nothing is off."""


Forms = Literal["first", "second"]
"""Family of equations that effects are planted by."""


@dataclass(frozen=True)
class Laboratory:
    """Drawn for one case: what records it, when, how far things are off, and how many trials there are.

    Parameters
    ----------
    recorder, clock, sampler
        Of all trials.
    placement
        How far things are off in each trial, drawn anew in every one (standard deviations).
    standing
        How far constants are off from what is stated, the same in all trials.
    warm_up
        What channels are off by until the sensors are warm.
    trials
        How many for calibration and for evaluation; drawn where None.
    forms
        Of what is planted.
    """

    recorder: Recorder = EXACT
    clock: Clock = USUAL
    sampler: Sampler = AT_ONCE
    placement: Placement = IN_PLACE
    standing: Placement = IN_PLACE
    warm_up: WarmUp = WARM
    trials: tuple[int, int] | None = None
    forms: Forms = "first"


HOME = Laboratory()
"""Adds nothing to a scene: noise as large everywhere, numbers in full, even samples, everything in its place."""

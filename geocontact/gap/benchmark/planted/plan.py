"""What every planted effect says of itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geocontact.gap.benchmark.planted.hooks import Hooks

Rng = np.random.Generator


@dataclass(frozen=True)
class Scale:
    """Magnitudes of a case in the base model.

    force, stroke [m], rate [m/s]: largest load, largest deflection, rms rate of deflection; low, high: its extremes;
    duration, step [s]; output: largest magnitude per channel; acceleration: rms of the first input's; middle: of it;
    `faithful` in 0..1 scales how far an effect departs from the plain law.
    """

    system: str
    force: float
    stroke: float
    low: float
    high: float
    rate: float
    duration: float
    step: float
    output: dict[str, float]
    acceleration: float
    middle: float
    departure: float = 1.0


@dataclass(frozen=True)
class Draw:
    """An effect with its shape settled and its amplitude open, which may be anything in `low`..`high`."""

    low: float
    high: float
    hooks: Callable[[float], Hooks]
    words: Callable[[float], str]
    variant: str = ""


@dataclass(frozen=True)
class Plan:
    """A planted effect: name of the vocabulary, the equation planted, the candidate's, and how to draw one."""

    name: str
    systems: tuple[str, ...]
    planted: str
    candidate: str
    draw: Callable[[Rng, Scale], Draw]

"""What every injected effect says of itself, and where it is drawn to sit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from geocontact.gap_benchmark.synthetic.hooks import Hooks

Rng = np.random.Generator
ALL = ("elbow", "foot", "shoulder", "knee", "sit_to_stand")
"""Systems of an effect that any of them may have."""
EVERYWHERE = 0.25
"""Share of effects that may stand at all places which do."""


class NotFoundError(RuntimeError):
    """No amplitude of this draw gives what is asked for."""


@dataclass(frozen=True)
class SyntheticMagnitudes:
    """Magnitudes of a case in the base model.

    force, stroke [m], rate [m/s]: largest load, largest deflection, rms rate of deflection; low, high: its extremes;
    duration, step [s]; output: largest magnitude per channel; acceleration: rms of the first input's; middle: of it;
    span: half its range; loads: outputs that are forces; places: the same for each of several interfaces, whose first
    input is the angle of its own; `departure` in 0..1 scales how far an effect departs from the plain law.
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
    span: float = 1.0
    loads: tuple[int, ...] = (0,)
    places: Mapping[str, SyntheticMagnitudes] = field(default_factory=dict)

    def load(self, rng: Rng) -> int:
        """One of the outputs that are forces, by row."""
        return self.loads[0] if len(self.loads) == 1 else int(rng.choice(self.loads))


@dataclass(frozen=True)
class Draw:
    """An effect with its shape settled and its amplitude open, which may be anything in `low`..`high`."""

    low: float
    high: float
    hooks: Callable[[float], Hooks]
    words: Callable[[float], str]
    variant: str = ""


@dataclass(frozen=True)
class InjectionPlan:
    """An injected effect: name of the vocabulary, the equation planted, the candidate's, and how to draw one.

    Of several interfaces one that is `placed` sits at one, or, where it may stand `together`, now and then at all.
    """

    name: str
    systems: tuple[str, ...]
    planted: str
    candidate: str
    draw: Callable[[Rng, SyntheticMagnitudes], Draw]
    placed: bool = False
    together: bool = False

    def drawn(self, rng: Rng, scale: SyntheticMagnitudes) -> Draw:
        """Shape, and the place where there are several."""
        if not self.placed or not scale.places:
            return self.draw(rng, scale)
        names = tuple(scale.places)
        everywhere = self.together and rng.random() < EVERYWHERE
        chosen = names if everywhere else (names[rng.integers(len(names))],)
        seed = int(rng.integers(2**62))  # alike in kind: magnitudes are those of each place
        draws = {name: self.draw(np.random.default_rng(seed), scale.places[name]) for name in chosen}
        first = draws[chosen[0]]
        where = "every site" if everywhere else chosen[0]
        parts = [] if everywhere else [chosen[0]]
        return Draw(
            max(one.low for one in draws.values()),
            min(one.high for one in draws.values()),
            lambda size: Hooks(places={name: one.hooks(size) for name, one in draws.items()}),
            lambda size: f"{where}: {first.words(size)}",
            ".".join([first.variant, *parts] if first.variant else parts),
        )

"""What a scene asks of a system: how it answers a movement, and which of its channels are what."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Values
from geocontact.gap_benchmark.synthetic.plan import EffectNumbers

Numbers = Mapping[str, float]


@dataclass(frozen=True)
class Site:
    """One of several interfaces: its name, the output and the input angle that are its own, by row."""

    name: str
    output: int
    angle: int


@dataclass(frozen=True)
class SyntheticSystem:
    """A base model written a second time from its definition, with its hooks.

    Parameters
    ----------
    respond
        (course, numbers, hooks) → the truth.
    base_model
        (course, constants) → outputs of the base model as a function of its parameters.
    motion
        (course, numbers) → deflections of the base model and their rates, "... t" with one row per interface.
    effects
        Which effects may be injected, and their numbers.
    loads
        Outputs that are forces.
    normal
        Those of them whose largest is the load of the interface.
    places
        Interfaces at each of which an effect may sit alone; () where there is but one, or where all are alike.
    spare
        Inputs that the base model does not use.
    quotients
        Outputs that a laboratory gets by a division, and by which output it divides.
    lengths
        Constants that are a length of how something sits.
    patchy
        Outputs of which a sample may be missing now and then.
    passed_on
        (course, numbers, row of an input, small noise of it "t q") → its part in the outputs "c t q"; None where
        outputs follow the inputs and their rates of the moment.
    fine
        Steps of the truth per sample to begin with.
    quickest
        How much quicker than at home it may move, so that a high rate does not make too many samples.
    recorded
        Outputs as a laboratory has them: NaN where nothing is measured.
    """

    respond: Callable[[InputCourse, Numbers, Hooks], Outputs]
    base_model: Callable[[InputCourse, Numbers], Callable[[Values], Values]]
    motion: Callable[[InputCourse, Numbers], tuple[Values, Values]]
    effects: EffectNumbers
    loads: tuple[int, ...] = (0,)
    normal: tuple[int, ...] = (0,)
    places: tuple[Site, ...] = ()
    spare: tuple[str, ...] = ()
    quotients: Mapping[int, int] = field(default_factory=dict)
    lengths: tuple[str, ...] = ()
    patchy: tuple[int, ...] = ()
    passed_on: Callable[[InputCourse, Numbers, int, Values], Values] | None = None
    fine: int = 10
    quickest: float = 1.0
    recorded: Callable[[Float[np.ndarray, "c t"]], Float[np.ndarray, "c t"]] = np.asarray

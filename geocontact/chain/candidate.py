"""One way to turn a system into one that has an effect."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from geocontact.chain.system import System
from geocontact.data.parameter import Parameter

Stage = Literal["timing", "kinematics", "geometry", "constitutive", "load", "sensor", "data"]

AT_END = 0.01  # of an amplitude's range: nearer to a bound it lies on it


@dataclass(frozen=True)
class Candidate:
    """One effect, in one variant, made for one system.

    Parameters
    ----------
    name, variant
        Of the vocabulary ("sensor_gain"), and which of several ("force_x"); "" where there is only one.
    stage
        Where in the chain it acts.
    parameters
        The amplitude first, then at most one shape; bounds are physical. Empty for a discrete mistake in the data.
    link
        Replaces one link; the parameters are added by `apply`.
    neutral
        Values of parameters at which the system with the effect is exactly the one without it.
    starts
        Values from which a search may set out. Given are those beside the parameters' own, which become the first; a
        parameter that is not named in one starts where it says itself.
    somewhere
        For mistakes in the data: `link` for the trials of these names only.
    channel, factor
        The one channel that it is about, "" where it is not one; and what that reads times too much, for a wrong unit.
    within
        For mistakes in the data: names of the trials that have it, where not all have.
    ways
        How many there would have been to choose the trials that have it.
    settles
        Whether the law no longer changes towards the amplitude's upper bound, as with a stop that is as good as rigid:
        an amplitude there is an answer, not a search that was cut short.
    ceiling
        Name of the parameter that no recorded magnitude of `channel` can pass but for noise; "" where there is none.

    Examples
    --------
    >>> import geocontact as gc
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> system = spring.build((gc.Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
    >>> shift = gc.candidates(system)[0]
    >>> shift.label, shift.stage, shift.parameters[0].unit, shift.apply(system).effects
    ('time_shift', 'timing', 's', ('time_shift',))
    """

    name: str
    variant: str
    stage: Stage
    parameters: tuple[Parameter, ...]
    link: Callable[[System], System]
    neutral: Mapping[str, float] = field(default_factory=dict)
    starts: tuple[Mapping[str, float], ...] = ()
    somewhere: Callable[[frozenset[str] | None], Callable[[System], System]] | None = None
    channel: str = ""
    factor: float = 1.0
    within: frozenset[str] = frozenset()
    ways: int = 1
    settles: bool = False
    ceiling: str = ""

    def __post_init__(self) -> None:
        first = {p.name: p.start for p in self.parameters}
        others = [{**first, **other} for other in self.starts]
        object.__setattr__(self, "starts", (first, *(other for other in others if other != first)))

    @property
    def label(self) -> str:
        """Name and variant in one word."""
        return f"{self.name}.{self.variant}" if self.variant else self.name

    def cut_short(self, values: Mapping[str, float]) -> bool:
        """Whether the amplitude lies on a bound of what is physical, other than where the effect is not there."""
        if not self.parameters:
            return False
        amplitude = self.parameters[0]
        still = self.neutral.get(amplitude.name, 0.0)
        above = amplitude.upper if still < amplitude.upper and not self.settles else math.inf
        below = amplitude.lower if still > amplitude.lower else -math.inf
        near = AT_END * (amplitude.upper - amplitude.lower)
        value = values[amplitude.name]
        return value >= above - near or value <= below + near

    def only(self, trials: frozenset[str]) -> Candidate:
        """The same mistake in the trials of these names only; ValueError for anything but a mistake in the data."""
        if self.somewhere is None:
            raise ValueError(f"{self.label} is not a mistake in the data; it is in every trial or in none")
        return replace(self, link=self.somewhere(trials), starts=(), within=trials)

    def apply(self, system: System) -> System:
        """The system with this effect. Refused when it is in already."""
        taken = {p.name for p in system.parameters} & {p.name for p in self.parameters}
        if taken or self.label in system.effects:
            raise ValueError(f"{self.label} is in this system already")
        changed = self.link(system)
        return replace(changed, parameters=system.parameters + self.parameters, effects=(*system.effects, self.label))

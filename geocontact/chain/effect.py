"""An effect of the vocabulary and the candidates that it offers for a system, at one site or at all of them.

An effect on law or geometry is offered by each place as if there were no other. At one place its parameters carry the
place's name ("stiffening.thigh.gain"); at all places together one set of parameters serves all, while magnitudes that
are no parameters (reference deflections, middles of ranges) stay those of each place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from geocontact.chain.links import LawParameters, Source
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


Offer = Callable[[System], tuple[Candidate, ...]]


def placed(offer: Offer, system: System, *, together: bool) -> tuple[Candidate, ...]:
    """What `offer` has for each place, and `together` for all of them, where there are several."""
    offered = {place: offer(system.at(place)) for place in system.places}
    found = [at_one(place, one) for place, some in offered.items() for one in some]
    if together and len(offered) > 1:
        variants = zip(*offered.values(), strict=True)
        found += [at_all(dict(zip(offered, alike, strict=True))) for alike in variants]
    return tuple(found)


def at_one(place: str, one: Candidate) -> Candidate:
    """The candidate of a place, in the whole system."""
    names = {p.name: _named(place, p.name) for p in one.parameters}
    return replace(
        one,
        variant=f"{one.variant}.{place}" if one.variant else place,
        parameters=tuple(replace(p, name=names[p.name]) for p in one.parameters),
        link=_linked({place: one}, names),
        neutral={names[name]: value for name, value in one.neutral.items()},
        starts=tuple({names[name]: value for name, value in start.items()} for start in one.starts),
    )


def at_all(alike: Mapping[str, Candidate]) -> Candidate:
    """The same candidate at all places, with the widest bounds of each parameter and the mean of its starts."""
    ones = list(alike.values())
    first = ones[0]
    starts = tuple(
        {name: sum(start[name] for start in same) / len(same) for name in same[0]}
        for same in zip(*(one.starts for one in ones), strict=True)
    )
    parameters = tuple(
        Parameter(
            same[0].name,
            same[0].unit,
            starts[0][same[0].name],
            min(p.lower for p in same),
            max(p.upper for p in same),
        )
        for same in zip(*(one.parameters for one in ones), strict=True)
    )
    names = {p.name: p.name for p in parameters}
    return replace(first, parameters=parameters, link=_linked(alike, names), starts=starts)


def _named(place: str, name: str) -> str:
    """Name of a parameter at a place, "stiffening.gain" → "stiffening.thigh.gain"."""
    effect, _, last = name.rpartition(".")
    return f"{effect}.{place}.{last}"


def _linked(alike: Mapping[str, Candidate], names: Mapping[str, str]) -> Callable[[System], System]:
    """Does at each place what its candidate does there, parameters read by their names in the whole system."""

    def link(system: System) -> System:
        for place, one in alike.items():
            before = system.at(place)
            after = one.link(before)
            law = _added(before.law.slots, after.law.slots, place, names)
            geometry = _added(before.geometry.slots, after.geometry.slots, place, names)
            system = replace(system, law=system.law.having(law), geometry=system.geometry.having(geometry))
        return system

    return link


def _added(before: LawParameters, after: LawParameters, place: str, names: Mapping[str, str]) -> dict[str, Source]:
    """What was added to the numbers of a place, as it is called in the whole system."""
    return {
        f"{place}.{name}": names.get(source, source) if isinstance(source, str) else source
        for name, source in after.sources.items()
        if name not in before.sources
    }


@dataclass(frozen=True)
class Effect:
    """A row of the vocabulary.

    Parameters
    ----------
    name
        As in `diagnosis.json`.
    stage
        Where in the chain it acts.
    offer
        Makes the candidates for a system; none where a system has no channel for it.
    source
        Where the formula is from.
    needs
        Numbers of the law or the geometry that it sets: it applies where all of them are free, of a system that makes
        contact at several places at each of these.
    together
        Whether, of several places of contact, all may have it alike; what depends on where a place is may not.

    Examples
    --------
    >>> import geocontact as gc
    >>> from dataclasses import replace
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> system = spring.build((gc.Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
    >>> tare = gc.Parameter("tare.torque", "N m", 0.5, -5.0, 5.0)
    >>> def link(one):
    ...     change = gc.chain.Modifier("tare", 5.0, lambda outputs, movement, values: outputs + values["tare.torque"])
    ...     return replace(one, sensor=one.sensor.having(change))
    >>> def offer(one):
    ...     return (gc.chain.Candidate("tare", "", "sensor", (tare,), link),)
    >>> effect = gc.chain.Effect("tare", "sensor", offer, "drawing 12 of the spring")
    >>> [one.label for one in effect.candidates(system)]
    ['tare']
    """

    name: str
    stage: Stage
    offer: Callable[[System], tuple[Candidate, ...]]
    source: str
    needs: tuple[str, ...] = ()
    together: bool = True

    def __post_init__(self) -> None:
        if not callable(self.offer):  # as it was until effects no longer named systems
            raise TypeError(f"{self.name}: offer comes third; an effect names no systems, only what it `needs`")

    def applies(self, system: System) -> bool:
        """Whether the links of the system have what it needs, and nothing sets it yet."""
        if not self.needs:
            return True
        places = [system.at(place) for place in system.places] or [system]
        links = [(one.law.slots, one.geometry.slots) for one in places]
        return all(any(slots.free(name) for slots in each) for each in links for name in self.needs)

    def candidates(self, system: System) -> tuple[Candidate, ...]:
        """Candidates for a system, with bounds from its scale; none where the effect does not apply."""
        if not self.applies(system):
            return ()
        return (
            placed(self.offer, system, together=self.together) if self.needs and system.places else self.offer(system)
        )

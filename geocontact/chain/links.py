"""The links of a chain: motion, geometry, law, balance, sensor. Effects replace one of them by one that does more."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Generic, Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import REACH, DifferentiatedInputs, recorded
from geocontact.data.trial import Trial

Source = str | float | Callable[[Mapping[str, float]], float]
"""A parameter, constant or covariate by its name; a fixed number; or a function of all of them."""


@dataclass(frozen=True)
class LawParameters:
    """Named numbers in a fixed order; those without a source stay neutral, as if their term were not there.

    Parameters
    ----------
    neutral
        Every number of the link in the order in which its kernel reads them, with the value that means "absent".
    sources
        For some of them where they come from: a name, a fixed number, or a function (a stiffness that depends on a
        trial's setting).

    Examples
    --------
    >>> import geocontact as gc
    >>> slots = gc.chain.LawParameters({"k": 0.0, "power": 1.0}).having({"k": "stiffness"})
    >>> slots.numbers({"stiffness": 60.0}).tolist(), slots.free("power")
    ([60.0, 1.0], True)
    >>> list(slots.apart(("thigh", "shank")).neutral)
    ['thigh.k', 'thigh.power', 'shank.k', 'shank.power']
    """

    neutral: Mapping[str, float]
    sources: Mapping[str, Source] = field(default_factory=lambda: MappingProxyType({}))

    def free(self, name: str) -> bool:
        """Whether the link has such a number and nothing sets it yet."""
        return name in self.neutral and name not in self.sources

    def having(self, sources: Mapping[str, Source]) -> LawParameters:
        """The same link with more of its numbers coming from somewhere.

        A number that the link does not know, or that has a source already, is refused: an effect is added once.
        """
        for name in sources:
            if name not in self.neutral:
                raise ValueError(f"this link has no {name}; it has {', '.join(self.neutral)}")
            if name in self.sources:
                raise ValueError(f"{name} is set already, by {self.sources[name]}")
        return replace(self, sources={**self.sources, **sources})

    def apart(self, places: Sequence[str]) -> LawParameters:
        """The same numbers once for every place, "thigh.k"; those of the first place come first."""
        neutral = {f"{place}.{name}": value for place in places for name, value in self.neutral.items()}
        return LawParameters(neutral, {f"{place}.{name}": s for place in places for name, s in self.sources.items()})

    def at(self, place: str) -> LawParameters:
        """The numbers of one place, named as if there were no other."""
        here = f"{place}."
        neutral = {name.removeprefix(here): v for name, v in self.neutral.items() if name.startswith(here)}
        return LawParameters(
            neutral, {name.removeprefix(here): s for name, s in self.sources.items() if name.startswith(here)}
        )

    def numbers(self, values: Mapping[str, float]) -> Float[np.ndarray, " slots"]:
        """All numbers in order; KeyError for a name that has no value."""
        found = self._fixed.copy()
        for place, source in self._open:
            found[place] = source(values) if callable(source) else values[source]
        return found

    def towards(
        self, values: Mapping[str, float], others: Sequence[Mapping[str, float]]
    ) -> Float[np.ndarray, "q slots"]:
        """How far each number is further on at other values; KeyError for a name that has no value."""
        found = np.zeros((len(others), len(self.neutral)))
        for place, source in self._open:
            own = source(values) if callable(source) else values[source]
            for k, other in enumerate(others):
                number = source(other) if callable(source) else other[source]
                if number != own:
                    found[k, place] = number - own
        return found

    @cached_property
    def _fixed(self) -> Float[np.ndarray, " slots"]:
        """Numbers that no parameter changes."""
        fixed = {name: s for name, s in self.sources.items() if not (isinstance(s, str) or callable(s))}
        return np.array([float(fixed.get(name, value)) for name, value in self.neutral.items()])

    @cached_property
    def _open(self) -> tuple[tuple[int, str | Callable[[Mapping[str, float]], float]], ...]:
        """Place and source of the others."""
        places = {name: place for place, name in enumerate(self.neutral)}
        return tuple((places[name], s) for name, s in self.sources.items() if isinstance(s, str) or callable(s))


RECORDING = 100.0
"""Rank of what a recording leaves out; what a sensor does has a smaller one, mistakes in the data a larger one."""
LAST = float("inf")
"""Rank of what is done after everything that is wrong with what passes."""

Values = Mapping[str, float]
T = TypeVar("T")


@dataclass(frozen=True)
class Modifier(Generic[T]):
    """One thing that is done to what passes through a link.

    Parameters
    ----------
    name
        Effect and variant; a link takes each only once.
    rank
        Modifiers act in the order of their ranks, then names, so it does not matter which was added first.
    change
        What is done: (what passes, movement, values) → what is passed on.
    trials
        Names of the trials that have it; None for all.
    apart
        Whether it does to each channel what depends on no other.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> gain = gc.chain.Modifier("sensor_gain", 5.0, lambda outputs, movement, values: outputs * values["gain"])
    >>> gain.change(np.array([[2.0], [4.0]]), None, {"gain": 1.5}).tolist()
    [[3.0], [6.0]]
    """

    name: str
    rank: float
    change: Callable[[T, DifferentiatedInputs, Values], T]
    trials: frozenset[str] | None = None
    apart: bool = False


def added(modifiers: tuple[Modifier[T], ...], one: Modifier[T]) -> tuple[Modifier[T], ...]:
    """`one` among `modifiers`, in order of rank; ValueError when it is there already."""
    if one.name in (other.name for other in modifiers):
        raise ValueError(f"{one.name} is in this link already; an effect is added once")
    return tuple(sorted((*modifiers, one), key=lambda each: (each.rank, each.name)))


def passed_on(modifiers: tuple[Modifier[T], ...], what: T, movement: DifferentiatedInputs, values: Values) -> T:
    """What is left after all modifiers that belong to this trial."""
    for each in modifiers:
        if each.trials is None or movement.trial in each.trials:
            what = each.change(what, movement, values)
    return what


@dataclass(frozen=True)
class Motion:
    """Recorded inputs of a trial, differentiated, then changed by what is wrong with them.

    Parameters
    ----------
    inputs
        Channels that drive the model.
    modifiers
        What is wrong with them.
    reach
        Rates come from local fits over so much time to either side [s]; 0 for central differences of the inputs as
        they were measured.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from geocontact.data.motion import Signals
    >>> from geocontact.data.trial import Trial
    >>> angle = np.array([[0.0], [0.1], [0.2], [0.3]])
    >>> trial = Trial("t1", Signals(0.1 * np.arange(4), angle, ("angle",), ("rad",)))
    >>> gc.chain.Motion(("angle",)).seen(trial, {}).rate.round(6).tolist()
    [[1.0, 1.0, 1.0, 1.0]]
    """

    inputs: tuple[str, ...]
    modifiers: tuple[Modifier[DifferentiatedInputs], ...] = ()
    reach: float = REACH

    def seen(self, trial: Trial, values: Values) -> DifferentiatedInputs:
        """Movement that the model works with."""
        known = replace(recorded(trial.signals, self.inputs, self.reach), trial=trial.name)
        return passed_on(self.modifiers, known, known, values)

    def having(self, one: Modifier[DifferentiatedInputs]) -> Motion:
        """The same link with one modifier more."""
        return replace(self, modifiers=added(self.modifiers, one))


@dataclass(frozen=True)
class Loads:
    """What the law gives along a movement, one column per deflection.

    Parameters
    ----------
    normal, tangential
        Forces [N]; tangential is zero where the system has none.
    arm
        Where each of them acts, for a balance that needs it [m].
    moved
        What the loads have moved, where a system has a body of its own that is measured [rad]; else no column.
    """

    normal: Float[np.ndarray, "t n"]
    tangential: Float[np.ndarray, "t n"]
    arm: Float[np.ndarray, "t n"]
    moved: Float[np.ndarray, "k m"] = field(default_factory=lambda: np.zeros((0, 0)))


@runtime_checkable
class Geometry(Protocol):
    """How the inputs deflect what carries the load; drives the law along the movement.

    It drives the law because a spring in series makes the deflection depend on the load.

    >>> import geocontact as gc, numpy as np
    >>> strut = gc.chain.SingleDeflection("angle", lambda angle, numbers: np.sin(angle - numbers["neutral"]))
    >>> isinstance(strut, gc.chain.Geometry), strut.yields
    (True, 'angle')
    """

    @property
    def slots(self) -> LawParameters:
        """Places of the numbers that the kernel reads."""

    @property
    def yields(self) -> str:
        """Input that gives way to a spring in series."""

    def having(self, sources: Mapping[str, Source]) -> Geometry:
        """The same link with more of its numbers coming from somewhere."""

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Forces along a movement."""

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """Deflections and their rates without any load, for scales."""


@runtime_checkable
class ContactSites(Geometry, Protocol):
    """A geometry of several places of contact that do not feel each other; numbers of each are called "thigh.rho".

    >>> import geocontact as gc
    >>> from geocontact.systems.sit_to_stand import SITE_GEOMETRY, InterfaceSites
    >>> cuffs = InterfaceSites(("thigh", "shank"), SITE_GEOMETRY.apart(("thigh", "shank")))
    >>> isinstance(cuffs, gc.chain.ContactSites), cuffs.at("shank").yields
    (True, 'shank_normal')
    """

    def at(self, place: str) -> Geometry:
        """The geometry of one place, its numbers named as if there were no other."""


@dataclass(frozen=True)
class Law:
    """Load of a deflection and of its history; which law it is, the geometry that drives it knows.

    Parameters
    ----------
    slots
        Its numbers.
    load, deflection
        Units of what it gives and of what it is given: N and m, or N m and rad for a joint.

    Examples
    --------
    >>> import geocontact as gc
    >>> law = gc.chain.Law(gc.chain.INTERFACE_LAW, load="N m", deflection="rad").having({"k": "stiffness", "b": 0.5})
    >>> law.slots.free("k"), law.slots.free("damping.b"), float(law.slots.numbers({"stiffness": 60.0})[0])
    (False, True, 60.0)
    """

    slots: LawParameters
    load: str = "N"
    deflection: str = "m"

    def having(self, sources: Mapping[str, Source]) -> Law:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def lacking(self, *names: str) -> Law:
        """The same law for a system that has no such terms: these numbers stay neutral, no effect sets them."""
        return self.having({name: self.slots.neutral[name] for name in names})


Channels = Float[np.ndarray, "t c"]


@dataclass(frozen=True)
class Balance:
    """Many loads to what a perfect sensor would read, then what else loads the sensor.

    >>> import geocontact as gc
    >>> balance = gc.chain.Balance(("torque",), lambda loads: loads.normal)
    >>> weight = gc.chain.Modifier("weight", 10.0, lambda outputs, movement, values: outputs + values["weight"])
    >>> balance.outputs, [one.name for one in balance.having(weight).modifiers]
    (('torque',), ['weight'])
    """

    outputs: tuple[str, ...]
    total: Callable[[Loads], Channels]
    modifiers: tuple[Modifier[Channels], ...] = ()

    def read(self, loads: Loads, movement: DifferentiatedInputs, values: Values) -> Channels:
        """True outputs."""
        return passed_on(self.modifiers, self.total(loads), movement, values)

    def having(self, one: Modifier[Channels]) -> Balance:
        """The same link with one modifier more."""
        return replace(self, modifiers=added(self.modifiers, one))


@dataclass(frozen=True)
class Sensor:
    """True outputs to measured ones: what the sensor does, what the recording leaves out, what is mixed up.

    >>> import geocontact as gc, numpy as np
    >>> offset = gc.chain.Modifier("offset", 5.0, lambda outputs, movement, values: outputs + values["offset"])
    >>> gc.chain.Sensor(("torque",)).having(offset).read(np.array([[2.0]]), None, {"offset": 0.5}).tolist()
    [[2.5]]
    """

    outputs: tuple[str, ...]
    modifiers: tuple[Modifier[Channels], ...] = ()

    def read(self, outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        """Measured outputs."""
        return passed_on(self.modifiers, outputs, movement, values)

    def having(self, one: Modifier[Channels]) -> Sensor:
        """The same link with one modifier more."""
        return replace(self, modifiers=added(self.modifiers, one))

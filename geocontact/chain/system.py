"""A system: a chain of replaceable links with named parameters, derivatives of its outputs, and loads that feed back.

Loads take nearly all of the time of a simulation. Their changes along all parameters are had at once, exact; balance
and sensor, which are cheap, are read a second time with loads and parameters so little further on that differences
show the derivative to seven digits. A balance sums loads of one sample, its modifiers what they like.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any, Protocol, TypeGuard, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import (
    Balance,
    ContactSites,
    Geometry,
    Law,
    Loads,
    Modifier,
    Motion,
    Sensor,
    Values,
    passed_on,
)
from geocontact.chain.magnitudes import Magnitudes, magnitudes_of
from geocontact.chain.traits import BY_UNIT, Role, Traits
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.geometry.kernels.compile import kernel

TOLERANCE = 1e-10
"""Largest residual of a solved load, over the load (or over the load scale where the load is smaller)."""
ATTEMPTS = 100
FINEST = 1e-8
"""Distance of two attempts, over the load and one unit more, below which rounding makes the slope between them."""
BELOW, ABOVE, LAST, RESIDUAL, COUNT, SLOPE = range(6)


@kernel
def nothing_known() -> Float[np.ndarray, " six"]:
    """State of a search before the first sample."""
    return np.array([-np.inf, np.inf, np.nan, np.nan, 0.0, 1.0])


@kernel
def start_over(search: Float[np.ndarray, " six"]) -> None:
    """Forget the last root, but not how steep the residual was there."""
    search[BELOW], search[ABOVE] = -np.inf, np.inf
    search[LAST] = search[RESIDUAL] = np.nan
    search[COUNT] = 0.0


@kernel
def next_load(load: float, residual: float, search: Float[np.ndarray, " six"]) -> float:
    """Where to look after `load` left `residual` = load - what the law gives for it.

    Secant through the last two attempts, at first with the slope found at the sample before; once the root lies between
    two attempts, a guess outside is replaced by their middle, and so is every fourth, which bounds the number of
    attempts whatever the law looks like. The residual rises with the load wherever more load means less deflection.
    """
    if residual < 0.0:
        search[BELOW] = max(search[BELOW], load)
    else:
        search[ABOVE] = min(search[ABOVE], load)
    apart = load - search[LAST]
    slope = (residual - search[RESIDUAL]) / apart
    if np.isfinite(slope) and slope > 0.0 and abs(apart) > FINEST * (1.0 + abs(load)):
        search[SLOPE] = slope
    search[LAST], search[RESIDUAL] = load, residual
    search[COUNT] += 1.0
    guess = load - residual / search[SLOPE]
    low, high = search[BELOW], search[ABOVE]
    stuck = search[COUNT] % 4.0 == 0.0
    if low < high and np.isfinite(low) and np.isfinite(high) and (stuck or not low < guess < high):
        return float(0.5 * (low + high))
    return float(guess)


class NotConverged(ArithmeticError):  # noqa: N818
    """A load could not be found at some samples; nothing that depends on it can be trusted."""


def require_convergence(unsolved: int, samples: int, compliance: float) -> None:
    """Raise when samples are left without a solution."""
    if not unsolved:
        return
    what = f"{min(unsolved, samples)} of {samples} samples have no load within {TOLERANCE:g}"
    if compliance == 0.0:
        raise NotConverged(f"{what}: the motion runs away, or the force grows beyond all bounds, with these numbers")
    raise NotConverged(f"series compliance {compliance:g}: {what}; a smaller compliance has one")


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


def tangents(
    system: System, trial: Trial, values: Mapping[str, float], steps: Mapping[str, float]
) -> dict[str, Float[np.ndarray, "t c"]]:
    """Derivative of the outputs by each parameter in `steps`, which says how far on it is looked; without those that
    are not known. 0 where the model has no value.
    """
    geometry, motion = system.geometry, system.motion
    if not _differentiated(geometry):
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
    balance = system.balance
    totals = [balance.total(loads), *(balance.total(_moved(loads, more)) for more in known.values())]
    before, *after = (
        system.sensor.read(passed_on(balance.modifiers, total, movement, further), movement, further)
        for total, further in zip(totals, (numbers, *(others[name] for name in known)), strict=True)
    )
    slopes = {}
    for name, own in zip(known, after, strict=True):
        change = (own - before) / steps[name]
        slopes[name] = np.where(np.isfinite(change), change, 0.0)
    return slopes


@cache
def _has_changes(kind: type) -> bool:
    """Whether a kind of geometry knows how its loads change: a protocol takes long to compare."""
    return issubclass(kind, DifferentiatedLoads)


def _differentiated(geometry: Geometry) -> TypeGuard[DifferentiatedLoads]:
    return _has_changes(type(geometry))


def _same(one: DifferentiatedInputs, other: DifferentiatedInputs) -> bool:
    arrays = ((one.position, other.position), (one.rate, other.rate), (one.acceleration, other.acceleration))
    return all(a is b or np.array_equal(a, b, equal_nan=True) for a, b in arrays)


def _moved(loads: Loads, more: Loads) -> Loads:
    """Loads with a change of them; where they act stays."""
    return Loads(loads.normal + more.normal, loads.tangential + more.tangential, loads.arm, loads.moved + more.moved)


FAR = 1e9
"""Output of a model that has none [the output's unit]: finite, and so far off that no search stays there."""


@runtime_checkable
class Offering(Protocol):
    """What candidates come from; `chain.effect.Effect` is one."""

    def candidates(self, system: System) -> tuple[Any, ...]:
        """Candidates for a system."""


@dataclass(frozen=True)
class System:
    """Base model, or base model with effects; frozen, so an effect makes another one by `dataclasses.replace`.

    Parameters
    ----------
    name
        As in case.toml ("elbow").
    motion, geometry, law, balance, sensor
        The links.
    parameters
        Of the base and of the effects that were added, in this order.
    constants
        Known and exact as far as anyone knows.
    scale
        Magnitudes of this system on its trials, in which effects state their bounds.
    effects
        Names of the candidates that were added.
    units
        SI unit of each channel.
    own
        Effects that the model brings beside those of the vocabulary.
    spare
        Inputs that the base does not use; effects may.
    bias
        Largest constant error of an input that is plausible, where the model knows more of it than its unit says.
    places
        Where it makes contact, if there are several places that do not feel each other; the names of their channels and
        the numbers of their law and geometry begin with theirs ("thigh_force", "thigh.k").
    dynamic
        Whether the base has a motion of its own, so that outputs feel what inputs did before; otherwise they answer to
        values and rates of the moment.
    lengths
        Constants that are lengths of the device, or of how it is placed [m].
    extent
        Largest length of the device where no constant tells it [m]; 0 where the model does not know.
    quotients
        Outputs that are a moment over another output, by name of that one: {"cop_x": "force_y"}.
    traits
        What effects ask beyond that: roles of channels, which way it pushes, plausible sizes.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from geocontact.data.motion import Signals
    >>> from geocontact.data.trial import Trial
    >>> angle = np.array([[0.0], [0.1], [0.2], [0.3]])
    >>> trial = Trial("t1", Signals(0.1 * np.arange(4), angle, ("angle",), ("rad",)))
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> system = spring.build((gc.Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
    >>> system.simulate(trial, {"k": 60.0}).round(6).ravel().tolist()
    [0.0, 6.0, 12.0, 18.0]
    """

    name: str
    motion: Motion
    geometry: Geometry
    law: Law
    balance: Balance
    sensor: Sensor
    parameters: tuple[Parameter, ...]
    constants: Mapping[str, float]
    scale: Magnitudes
    effects: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    own: tuple[Offering, ...] = ()
    spare: tuple[str, ...] = ()
    bias: Mapping[str, float] = field(default_factory=dict)
    places: tuple[str, ...] = ()
    dynamic: bool = False
    lengths: tuple[str, ...] = ()
    extent: float = 0.0
    quotients: Mapping[str, str] = field(default_factory=dict)
    traits: Traits = field(default_factory=Traits)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Channels that drive the model."""
        return self.motion.inputs

    @property
    def driving(self) -> tuple[str, ...]:
        """Inputs that the base uses: what is wrong with another one does not show."""
        return tuple(name for name in self.inputs if name not in self.spare)

    @property
    def outputs(self) -> tuple[str, ...]:
        """Channels that it predicts, in the order of the columns of `simulate`."""
        return self.balance.outputs

    @cached_property
    def known(self) -> dict[str, float]:
        """Values that need not be given: constants and fixed parameters."""
        return {**self.constants, **{p.name: p.start for p in self.parameters if p.fixed}}

    @property
    def length(self) -> float:
        """Largest length of the device [m]: what the model says, its lengths; else the half-range of its inputs."""
        lengths = [self.known[name] for name in self.lengths if name in self.known]
        lengths += [p.start for p in self.parameters if p.unit == "m" and "." not in p.name]
        found = max([self.extent, *map(abs, lengths)])
        moved = [self.scale.span.get(name, 0.0) for name in self.inputs if self.unit(name) == "m"]
        return found if found > 0.0 else max(moved, default=0.0)

    @cached_property
    def start(self) -> dict[str, float]:
        """Starting value of every free parameter."""
        return {p.name: p.start for p in self.parameters if not p.fixed}

    @cached_property
    def apart(self) -> dict[str, tuple[int, ...]]:
        """Outputs (columns) of each parameter that acts at one place only; empty where anything mixes the channels."""
        modifiers: tuple[Modifier[Any], ...] = (*self.motion.modifiers, *self.balance.modifiers, *self.sensor.modifiers)
        sources = [*self.law.slots.sources.items(), *self.geometry.slots.sources.items()]
        if not self.places or not all(one.apart for one in modifiers) or any(callable(s) for _, s in sources):
            return {}
        acts: dict[str, set[str]] = {}
        for name, source in sources:
            if isinstance(source, str):
                acts.setdefault(source, set()).add(name.partition(".")[0])
        columns = {
            place: tuple(c for c, name in enumerate(self.outputs) if name.startswith(f"{place}_"))
            for place in self.places
        }
        return {name: columns[next(iter(at))] for name, at in acts.items() if len(at) == 1}

    def unit(self, channel: str) -> str:
        """SI unit of a channel, "-" where the model does not say."""
        return self.units.get(channel, "-")

    def role(self, channel: str) -> Role:
        """What a channel is (`chain.traits.Role`): what the model says, else what its unit and quotients do."""
        if channel in self.traits.roles:
            return self.traits.roles[channel]
        return "centre" if channel in self.quotients else BY_UNIT.get(self.unit(channel), "")

    def simulate(self, trial: Trial, values: Mapping[str, float]) -> Float[np.ndarray, "t c"]:
        """Outputs of the model over a trial's samples.

        NaN only where the model has no value, as for a centre of pressure without force; finite for any finite values
        of the parameters, so that a search may try them: where a spring in series has no solution, every output of the
        trial is `FAR` (and `demand` raises, saying why). Values of free parameters must be given, those of
        constants and fixed parameters may be. Covariates of the trial are known by name as well, unless a parameter or
        constant has that name.
        """
        try:
            return self.demand(trial, values)
        except NotConverged:
            return np.full((len(trial), len(self.outputs)), FAR)

    def demand(self, trial: Trial, values: Mapping[str, float]) -> Float[np.ndarray, "t c"]:
        """The same; NotConverged, saying why, where there is no solution."""
        numbers = {**trial.covariates, **self.known, **values}
        movement = self.motion.seen(trial, numbers)
        loads = self.geometry.loads(movement, self.law, numbers)
        return self.sensor.read(self.balance.read(loads, movement, numbers), movement, numbers)

    def as_measured(self) -> System:
        """The same system seeing its inputs as they were measured, their rates by central differences."""
        return self.reaching(0.0)

    def reaching(self, reach: float) -> System:
        """The same system with rates of its inputs from local fits over so much time to either side [s]."""
        return replace(self, motion=replace(self.motion, reach=reach))

    def scaled(self, trials: Sequence[Trial], values: Mapping[str, float] | None = None) -> System:
        """The same system with its scale taken from `trials`, its base parameters at `values` or where they start.

        To be done before candidates are asked for; those made earlier keep the scale that they were made with.
        """
        numbers = [{**trial.covariates, **self.known, **self.start, **(values or {})} for trial in trials]
        movements = [self.motion.seen(trial, known) for trial, known in zip(trials, numbers, strict=True)]

        def of(one: System) -> Magnitudes:
            return magnitudes_of(one.geometry, one.outputs, trials, movements, numbers)

        return replace(self, scale=replace(of(self), places={place: of(self.at(place)) for place in self.places}))

    def at(self, place: str) -> System:
        """The base as if it made contact at one place only; ValueError when it has no such place."""
        if place not in self.places or not isinstance(self.geometry, ContactSites):
            raise ValueError(f"{self.name}: no place {place}; it has {', '.join(self.places) or 'none'}")
        inputs, outputs = (
            tuple(name for name in names if name.startswith(f"{place}_")) for names in (self.inputs, self.outputs)
        )
        return replace(
            self,
            motion=Motion(inputs, reach=self.motion.reach),
            geometry=self.geometry.at(place),
            law=replace(self.law, slots=self.law.slots.at(place)),
            balance=Balance(outputs, self.balance.total),
            sensor=Sensor(outputs),
            scale=self.scale.places.get(place, self.scale),
            spare=tuple(name for name in self.spare if name in inputs),
            places=(),
        )

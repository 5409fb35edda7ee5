"""A model refitted to trials, base and effect parameters together, under a given whitening of the residuals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import zip_longest

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System, tangents
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.identify.optimise.bounded_gauss_newton import STEP, GaussNewtonResult, least
from geocontact.identify.optimise.least_squares import NO_VALUE

ROUNDS = 24  # of a search to its end; twice as many from far away, half of it where it sets out near
ENOUGH = 0.01  # nats that a search does not go on for


Whiten = Callable[[Float[np.ndarray, "t c p"]], Float[np.ndarray, "n p"]]
"""Whitening of one trial's columns."""


@dataclass(frozen=True)
class Measured:
    """Trials and what was measured in them; `rough` is a scale of each channel's noise, for samples without model."""

    trials: tuple[Trial, ...]
    outputs: tuple[Float[np.ndarray, "_ c"], ...]
    rough: Float[np.ndarray, " c"]

    @classmethod
    def of(cls, system: System, trials: Sequence[Trial], rough: Float[np.ndarray, " c"]) -> Measured:
        """The channels that a system predicts."""
        return cls(
            tuple(trials), tuple(np.stack([t.column(name) for name in system.outputs], axis=1) for t in trials), rough
        )

    @cached_property
    def present(self) -> tuple[np.ndarray, ...]:
        """Which samples were measured."""
        return tuple(np.isfinite(values) for values in self.outputs)

    def residuals(self, system: System, values: Mapping[str, float]) -> list[Float[np.ndarray, "_ c"]]:
        """Measured minus predicted; 0 where nothing was measured."""
        found = []
        for trial, measured in zip(self.trials, self.outputs, strict=True):
            off = measured - system.simulate(trial, values)
            silent = np.isnan(off)
            if silent.any():
                off = np.where(silent, np.where(np.isfinite(measured), NO_VALUE * self.rough, 0.0), off)
            found.append(off)
        return found


@dataclass(frozen=True)
class Refit:
    """Best values of the free parameters and what the residual is made of.

    Parameters
    ----------
    system, values
        The model, and its free parameters by name.
    residuals
        Per trial, in the channels' units.
    jacobian
        Derivative of the prediction, per trial.
    whitened, whitened_jacobian
        The same, weighed, trials one below the other.
    passed_on
        What more noise in the inputs makes of the prediction, per trial; empty where nobody asked.
    """

    system: System
    values: dict[str, float]
    residuals: list[Float[np.ndarray, "_ c"]]
    jacobian: list[Float[np.ndarray, "_ c p"]]
    whitened: Float[np.ndarray, " n"]
    whitened_jacobian: Float[np.ndarray, "n p"]
    passed_on: tuple[Float[np.ndarray, "_ c"], ...] = ()

    @classmethod
    def bare(
        cls,
        system: System,
        values: Mapping[str, float],
        residuals: list[Float[np.ndarray, "_ c"]],
        jacobian: list[Float[np.ndarray, "_ c p"]],
    ) -> Refit:
        """Nothing whitened yet."""
        return cls(system, dict(values), residuals, jacobian, np.zeros(0), np.zeros((0, jacobian[0].shape[-1])))

    def weighed(self, whitenings: Sequence[Whiten]) -> Refit:
        """The same model and values, whitened otherwise."""
        both = [np.concatenate([r[..., None], j], axis=-1) for r, j in zip(self.residuals, self.jacobian, strict=True)]
        whitened = np.concatenate([w(part) for w, part in zip(whitenings, both, strict=True)])
        return replace(self, whitened=whitened[:, 0], whitened_jacobian=whitened[:, 1:])

    @property
    def cost(self) -> float:
        """Half the sum of squares: nats."""
        return 0.5 * float(self.whitened @ self.whitened)


def free(system: System) -> list[Parameter]:
    """Parameters that are fitted."""
    return [p for p in system.parameters if not p.fixed]


def magnitude(p: Parameter) -> float:
    """What a parameter is measured in during a search."""
    width = p.upper - p.lower
    spare = 0.1 * width if np.isfinite(width) and width > 0.0 else 1.0
    return abs(p.start) if abs(p.start) > 1e-3 * spare else spare


def derivatives(
    system: System, measured: Measured, values: Mapping[str, float], base: Sequence[np.ndarray] | None = None
) -> list[Float[np.ndarray, "_ c p"]]:
    """Derivative of the prediction with respect to each free parameter, per trial.

    Exact where the model's geometry knows them (`chain.system`), else by one-sided differences: parameters that no
    output has two of are moved at once (Curtis, Powell & Reid 1974, J. Inst. Math. Appl. 13:117). 0 in a trial in which
    so small a step changes a prediction by a thousand times its channel's largest value: the motion left its way.
    """
    parameters = free(system)
    near = {p.name: _step(p, values[p.name]) for p in parameters}
    known = [tangents(system, trial, values, near) for trial in measured.trials]
    left = {p.name for p in parameters if any(p.name not in each for each in known)}
    out = [np.zeros((*there.shape, len(parameters))) for there in measured.present]
    for k, p in enumerate(parameters):
        if p.name not in left:
            for slopes, each, there in zip(out, known, measured.present, strict=True):
                slopes[..., k] = np.where(there, each[p.name], 0.0)
    if not left:
        return out
    start = measured.residuals(system, values) if base is None else base
    largest = np.array([system.scale.of(name) for name in system.outputs])
    for some in moved_at_once(system, parameters):
        group = [k for k in some if parameters[k].name in left]
        if not group:
            continue
        steps = {parameters[k].name: _step(parameters[k], values[parameters[k].name]) for k in group}
        moved = measured.residuals(system, {**values, **{name: values[name] + by for name, by in steps.items()}})
        for k in group:
            name = parameters[k].name
            columns = system.apart.get(name, slice(None)) if len(group) > 1 else slice(None)
            for slopes, before, after in zip(out, start, moved, strict=True):
                change = before[:, columns] - after[:, columns]
                steady = (np.abs(change) < 1e3 * largest[columns]).all()
                slopes[:, columns, k] = change / steps[name] if steady else 0.0
    return out


def _step(p: Parameter, value: float) -> float:
    """A small share of a parameter's magnitude, back where there is no room ahead."""
    step = STEP * magnitude(p)
    return -step if value + step > p.upper else step


def moved_at_once(system: System, parameters: Sequence[Parameter]) -> list[list[int]]:
    """Places of the parameters in groups that share no output; alone what acts on everything."""
    groups = [[k] for k, p in enumerate(parameters) if p.name not in system.apart]
    at: dict[tuple[int, ...], list[int]] = {}
    for k, p in enumerate(parameters):
        if p.name in system.apart:
            at.setdefault(system.apart[p.name], []).append(k)
    return groups + [[k for k in some if k is not None] for some in zip_longest(*at.values())]


def refit(
    system: System,
    measured: Measured,
    whitenings: Sequence[Whiten],
    starts: Sequence[Mapping[str, float]],
    rounds: int = ROUNDS // 2,
    useful: float = np.inf,
    known: Sequence[Refit] = (),
) -> Refit:
    """Bounded least squares of the weighed residuals, the best of several starts.

    `rounds` are those of each start. A start is left as soon as it does not promise to come `ENOUGH` below
    those before it, and below the cost `useful`. Fits of the same system to the same trials that are `known`, however
    they were weighed, are not simulated again where a search sets out from them; trials after these do not count.
    """
    if not free(system):
        return at(system, measured, whitenings, {})
    search = RefitSearch(system, measured, whitenings, known)
    best, cost = None, np.inf
    for start in starts:
        found = search.from_start(start, rounds, min(useful, cost - ENOUGH))
        if found.cost < cost:
            best, cost = search.reached(found.x), found.cost
    search.forget()
    if best is None:
        raise ValueError("a search without a start")
    return best.weighed(whitenings)


class RefitSearch:
    """Least squares over the free parameters, each in its magnitude; nothing is simulated twice at one place."""

    def __init__(
        self, system: System, measured: Measured, whitenings: Sequence[Whiten], known: Sequence[Refit] = ()
    ) -> None:
        self.parameters = free(system)
        self.scale = np.array([magnitude(p) for p in self.parameters])
        self.lower = np.array([p.lower for p in self.parameters]) / self.scale
        self.upper = np.array([p.upper for p in self.parameters]) / self.scale
        self.system, self.whitenings = system, whitenings
        count, there = len(measured.trials), {self.point(one.values).tobytes(): one for one in known}
        self.there = there

        @lru_cache(maxsize=2)  # where the search stands, and where it tries to go
        def residuals(point: bytes) -> list[Float[np.ndarray, "_ c"]]:
            if point in there:
                return there[point].residuals[:count]
            return measured.residuals(system, self.values(np.frombuffer(point)))

        @lru_cache(maxsize=1)
        def slopes(point: bytes) -> list[Float[np.ndarray, "_ c p"]]:
            if point in there:
                return there[point].jacobian[:count]
            return derivatives(system, measured, self.values(np.frombuffer(point)), residuals(point))

        self.residuals, self.slopes = residuals, slopes

    def forget(self) -> None:
        """Let go of all residuals and slopes: the functions that hold them refer to this search and it to them."""
        self.there.clear()
        self.residuals.cache_clear()
        self.slopes.cache_clear()

    def values(self, z: Float[np.ndarray, " p"]) -> dict[str, float]:
        """Parameters by name."""
        return {p.name: float(v) for p, v in zip(self.parameters, z * self.scale, strict=True)}

    def point(self, start: Mapping[str, float]) -> Float[np.ndarray, " p"]:
        """Where these values are in the search, the parameters' own start where they say nothing."""
        return np.asarray(np.array([start.get(p.name, p.start) for p in self.parameters]) / self.scale)

    def from_start(self, start: Mapping[str, float], rounds: int, useful: float = np.inf) -> GaussNewtonResult:
        """The least cost near a start, from the parameters' own where it says nothing."""

        def residual(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
            return self._weighed([r[..., None] for r in self.residuals(z.tobytes())])[:, 0]

        def slope(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
            return np.asarray(-self._weighed(self.slopes(z.tobytes())) * self.scale)

        inside = np.clip(self.point(start), self.lower + 0.1 * STEP, self.upper - 0.1 * STEP)
        return least(residual, slope, inside, self.lower, self.upper, rounds, ENOUGH, useful)

    def reached(self, z: Float[np.ndarray, " p"]) -> Refit:
        """The model where a search ended."""
        point = z.tobytes()
        return Refit.bare(self.system, self.values(z), self.residuals(point), self.slopes(point))

    def _weighed(self, parts: Sequence[Float[np.ndarray, "_ c p"]]) -> Float[np.ndarray, "n p"]:
        return np.concatenate([w(part) for w, part in zip(self.whitenings, parts, strict=True)])


def at(system: System, measured: Measured, whitenings: Sequence[Whiten] | None, values: Mapping[str, float]) -> Refit:
    """A model at given values, nothing fitted; without whitenings nothing is whitened either."""
    residuals = measured.residuals(system, values)
    model = Refit.bare(system, values, residuals, derivatives(system, measured, values, residuals))
    return model if whitenings is None else model.weighed(whitenings)

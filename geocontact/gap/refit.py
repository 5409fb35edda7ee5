"""A model refitted to trials, base and effect parameters together, under a given weighing of the residuals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial

STEP = 1e-5  # of a parameter's magnitude, for differences
NO_VALUE = 3.0  # residual, in rough noise levels, where something was measured and the model has no value


Weigh = Callable[[Float[np.ndarray, "t c p"]], Float[np.ndarray, "n p"]]
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
    """

    system: System
    values: dict[str, float]
    residuals: list[Float[np.ndarray, "_ c"]]
    jacobian: list[Float[np.ndarray, "_ c p"]]
    whitened: Float[np.ndarray, " n"]
    whitened_jacobian: Float[np.ndarray, "n p"]

    def weighed(self, weighings: Sequence[Weigh]) -> Refit:
        """The same model and values, whitened otherwise."""
        both = [np.concatenate([r[..., None], j], axis=-1) for r, j in zip(self.residuals, self.jacobian, strict=True)]
        whitened = np.concatenate([w(part) for w, part in zip(weighings, both, strict=True)])
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
    """Derivative of the prediction with respect to each free parameter, per trial, by one-sided differences."""
    start = measured.residuals(system, values) if base is None else base
    columns: list[list[np.ndarray]] = [[] for _ in measured.trials]
    for p in free(system):
        step = STEP * magnitude(p)
        step = -step if values[p.name] + step > p.upper else step
        moved = measured.residuals(system, {**values, p.name: values[p.name] + step})
        for column, before, after in zip(columns, start, moved, strict=True):
            column.append((before - after) / step)
    return [np.stack(c, axis=-1) if c else np.zeros((*r.shape, 0)) for c, r in zip(columns, start, strict=True)]


def refit(
    system: System,
    measured: Measured,
    weighings: Sequence[Weigh],
    starts: Sequence[Mapping[str, float]],
    rounds: int = 12,
) -> Refit:
    """Bounded least squares of the weighed residuals, the best of several starts."""
    from scipy.optimize import least_squares

    parameters = free(system)
    names = [p.name for p in parameters]
    scale = np.array([magnitude(p) for p in parameters])
    lower = np.array([p.lower for p in parameters]) / scale
    upper = np.array([p.upper for p in parameters]) / scale

    def values_at(z: Float[np.ndarray, " p"]) -> dict[str, float]:
        return dict(zip(names, map(float, z * scale), strict=True))

    def weighed(parts: Sequence[np.ndarray]) -> np.ndarray:
        return np.concatenate([w(part) for w, part in zip(weighings, parts, strict=True)])

    def residual(z: Float[np.ndarray, " p"]) -> np.ndarray:
        return weighed([r[..., None] for r in measured.residuals(system, values_at(z))])[:, 0]

    def slope(z: Float[np.ndarray, " p"]) -> np.ndarray:
        return np.asarray(-weighed(derivatives(system, measured, values_at(z))) * scale)

    best, least = None, np.inf
    for start in starts:
        z = np.array([start.get(p.name, p.start) for p in parameters]) / scale
        inside = np.clip(z, lower + 1e-6, upper - 1e-6)
        if not parameters:
            best = inside
            break
        found = least_squares(
            residual, inside, slope, bounds=(lower, upper), max_nfev=rounds, ftol=1e-5, xtol=1e-6, gtol=1e-6
        )
        if found.cost < least:
            best, least = found.x, found.cost
    if best is None:
        raise ValueError("a search without a start")
    return at(system, measured, weighings, values_at(best))


def at(system: System, measured: Measured, weighings: Sequence[Weigh] | None, values: Mapping[str, float]) -> Refit:
    """A model at given values, nothing fitted; without weighings nothing is whitened either."""
    residuals = measured.residuals(system, values)
    jacobian = derivatives(system, measured, values, residuals)
    empty = np.zeros((0, jacobian[0].shape[-1]))
    model = Refit(system, dict(values), residuals, jacobian, np.zeros(0), empty)
    return model if weighings is None else model.weighed(weighings)

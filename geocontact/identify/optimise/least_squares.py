"""Parameters from several trials at once: bounded nonlinear least squares from several starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from geocontact.data.parameter import Parameter
from geocontact.identify.optimise.bounded_gauss_newton import STEP

Predict = Callable[[Mapping[str, float]], list[Float[np.ndarray, "_ c"]]]
"""Predicted channels of every trial at given values of the free parameters."""

NO_VALUE = 3.0  # residual, in floors, where something was measured and the model has no value


@dataclass(frozen=True)
class SearchRecord:
    """How one search went: calls of the objective up to the end of each iteration, and the cost there.

    Parameters
    ----------
    calls
        Calls so far, an entry for each iteration; the first is the start's own.
    costs
        Cost there, as that of `Fit`.
    message
        Why it ended.
    """

    calls: tuple[int, ...]
    costs: tuple[float, ...]
    message: str


@dataclass(frozen=True)
class Fit:
    """Values of the free parameters, and how well they are known.

    Parameters
    ----------
    values
        By name.
    names
        Order of the columns of `jacobian`.
    cost
        Half the sum of squared residuals, each channel divided by its floor.
    residuals
        Measured minus predicted, in the channel's unit, per trial; NaN where one of them has no value.
    jacobian
        Derivative of the prediction with respect to each parameter, per trial.
    converged
        Whether the search of the best start ended by itself.
    costs
        Final cost of every start.
    record
        How each search went, where one was recorded.
    """

    values: dict[str, float]
    names: tuple[str, ...]
    cost: float
    residuals: list[Float[np.ndarray, "_ c"]]
    jacobian: list[Float[np.ndarray, "_ c p"]]
    converged: bool
    costs: tuple[float, ...]
    record: tuple[SearchRecord, ...] = ()


def fit(
    predict: Predict,
    measured: Sequence[Float[np.ndarray, "_ c"]],
    parameters: Sequence[Parameter],
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Mapping[str, float]] = ({},),
) -> Fit:
    """Least squares over all trials and channels within the parameters' bounds, the best of several starts.

    Parameters
    ----------
    predict
        The model; called with the values of the free parameters.
    measured
        What it is to predict; NaN where nothing was measured.
    parameters
        Fixed ones are left alone.
    floor
        Standard deviation that each channel is divided by.
    starts
        Values that differ from the parameters' own starts; one search each. Values beyond the bounds are moved to them.
    """
    free = [p for p in parameters if not p.fixed]
    names = tuple(p.name for p in free)
    lower, upper = np.array([p.lower for p in free]), np.array([p.upper for p in free])
    scale = np.array([_scale(p) for p in free])

    def residual(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        predicted = predict(dict(zip(names, z * scale, strict=True)))
        return np.concatenate([divided(p, m, floor) for p, m in zip(predicted, measured, strict=True)])

    if not free:
        return _fit_at(predict, measured, free, np.zeros(0), residual(np.zeros(0)), True, ())
    searches = []
    for start in starts:
        z = np.array([start.get(p.name, p.start) for p in free])
        inside = np.clip(z, lower + 1e-9 * scale, upper - 1e-9 * scale) / scale
        searches.append(
            least_squares(
                residual,
                inside,
                bounds=(lower / scale, upper / scale),
                diff_step=np.array(STEP),
                xtol=1e-10,
                ftol=1e-10,
            )
        )
    best = min(searches, key=lambda search: search.cost)
    costs = tuple(float(search.cost) for search in searches)
    return _fit_at(predict, measured, free, best.x * scale, best.fun, bool(best.status > 0), costs)


def _scale(p: Parameter) -> float:
    """Magnitude of a parameter: that of its start, or a share of its range where that is no more telling."""
    width = p.upper - p.lower
    spare = 0.1 * width if np.isfinite(width) and width > 0.0 else 1.0
    return abs(p.start) if p.over_decades or abs(p.start) > 1e-3 * spare else spare


def within_bounds(p: Parameter, value: float) -> tuple[float, float]:
    """Values beside one, for a difference that does not leave the bounds: beyond them a law need not be defined."""
    size = max(abs(p.start), abs(value)) if p.over_decades else _scale(p)
    below, above = max(value - STEP * size, p.lower), min(value + STEP * size, p.upper)
    return (below, above) if below < above else (value - STEP * size, value + STEP * size)


def divided(
    predicted: Float[np.ndarray, "t c"], measured: Float[np.ndarray, "t c"], floor: Float[np.ndarray, " c"]
) -> Float[np.ndarray, " n"]:
    """Residuals in floors, without the cells that were not measured. ValueError where the sizes do not fit."""
    if predicted.shape != measured.shape or floor.shape != predicted.shape[1:]:
        shapes = f"{predicted.shape} predicted, {measured.shape} measured, {floor.shape} floors"
        raise ValueError(f"channels do not fit: {shapes}")
    off = (predicted - measured) / floor
    off[np.isnan(predicted)] = NO_VALUE
    return np.asarray(off[np.isfinite(measured)])


def _fit_at(
    predict: Predict,
    measured: Sequence[Float[np.ndarray, "_ c"]],
    free: Sequence[Parameter],
    best: Float[np.ndarray, " p"],
    residual: Float[np.ndarray, " n"],
    converged: bool,
    costs: tuple[float, ...],
) -> Fit:
    names = tuple(p.name for p in free)
    predicted = predict(dict(zip(names, best, strict=True)))
    columns: list[list[np.ndarray]] = [[] for _ in measured]
    for k, parameter in enumerate(free):
        ends, pair = within_bounds(parameter, float(best[k])), []
        for end in ends:
            moved = best.copy()
            moved[k] = end
            pair.append(predict(dict(zip(names, moved, strict=True))))
        for trial, (below, above) in enumerate(zip(*pair, strict=True)):
            columns[trial].append((above - below) / (ends[1] - ends[0]))
    jacobian = [np.stack(c, axis=-1) if c else np.zeros((*m.shape, 0)) for c, m in zip(columns, measured, strict=True)]
    return Fit(
        values=dict(zip(names, map(float, best), strict=True)),
        names=names,
        cost=0.5 * float(residual @ residual),
        residuals=[m - p for m, p in zip(measured, predicted, strict=True)],
        jacobian=jacobian,
        converged=converged,
        costs=costs,
    )

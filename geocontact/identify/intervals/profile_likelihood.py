"""Intervals by profile likelihood when the residual remembers: the independence likelihood, adjusted.

The profile of a parameter is the least sum of squares with the parameter held. In the linear case it rises by
delta^2 / [(J'J)^-1]_jj at a distance delta. It is cut where that parabola would have the half-width that the
estimate has under noise with a memory (`memory`), so that the interval keeps the profile's own shape, lopsided where
the model is not linear, and has the right size. This is the vertical adjustment of Chandler and Bate (2007),
Biometrika 94, 167.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from geocontact.data.parameter import Parameter
from geocontact.identify.noise.autocorrelation import Autocorrelation, sandwich, spread
from geocontact.identify.optimise.least_squares import Fit, Predict
from geocontact.identify.optimise.least_squares import fit as least_squares

POINTS = 21  # of the curve that is drawn
DOUBLINGS = 30  # of the half-width in search of an end


@dataclass(frozen=True, eq=False)
class Profile:
    """Profile of one parameter.

    Parameters
    ----------
    parts
        Intervals in rising order, none touching the next: one, or one around each of several minima.
    lower_open, upper_open
        True where the profile is still below the cut at the parameter's bound: the data set no limit on that side.
    values, rise
        The curve: the parameter, and how far the sum of squares rises above its least, in units of the cut.
    """

    name: str
    best: float
    parts: tuple[tuple[float, float], ...]
    lower_open: bool
    upper_open: bool
    values: Float[np.ndarray, " m"]
    rise: Float[np.ndarray, " m"]

    @property
    def lower(self) -> float:
        """Least value within."""
        return self.parts[0][0]

    @property
    def upper(self) -> float:
        """Largest value within."""
        return self.parts[-1][1]


def profile(
    predict: Predict,
    measured: Float[np.ndarray, " n"],
    time: Float[np.ndarray, " n"],
    parameters: Sequence[Parameter],
    fit: Fit,
    memory: Autocorrelation,
    name: str,
    level: float = 0.95,
    points: int = POINTS,
) -> Profile:
    """Profile of one parameter of a fit of one channel in one trial, and its interval of probability `level`."""
    jacobian = fit.jacobian[0][:, 0, :]
    j, best = fit.names.index(name), fit.values[name]
    parameter = next(p for p in parameters if p.name == name)
    half = memory.half_width(np.sqrt(sandwich(memory, time, jacobian)[:, j, j]), level)
    if half <= 1e-12 * abs(best):
        return Profile(name, best, ((best, best),), False, False, np.array([best]), np.zeros(1))
    least = float(fit.residuals[0][:, 0] @ fit.residuals[0][:, 0])

    def held(value: float) -> float:
        return _least_squares_at(predict, measured, parameters, fit, name, value)

    return profile_of(held, least, parameter, best, half, float(spread(jacobian)[j, j]), points)


def profile_of(
    held: Callable[[float], float],
    least: float,
    parameter: Parameter,
    best: float,
    half: float,
    inverse: float,
    points: int = POINTS,
    others: Sequence[float] = (),
) -> Profile:
    """Profile of a parameter where an interval of half-width `half` would hold it if the model were linear.

    Parameters
    ----------
    held
        Least sum of squares with the parameter held at a value.
    least
        The same with the parameter free, at `best`.
    inverse
        Entry of the parameter in (J'J)^-1, J being the derivatives of what is squared.
    others
        Values at further minima. Around each of them at which the profile is below the cut there is an interval too;
        intervals that overlap are one. The curve shows what lies between.
    """
    cut = half**2 / inverse

    def rise(value: float) -> float:
        return (held(value) - least) / cut

    within = [best, *(value for value in others if rise(value) < 1.0)]
    ends = [[_end(rise, value, way * half, parameter) for way in (-1.0, 1.0)] for value in within]
    parts = _united([(lower, upper) for (lower, _), (upper, _) in ends])
    low, high = parts[0][0], parts[-1][1]
    values = np.linspace(
        max(best + 1.3 * (low - best), parameter.lower), min(best + 1.3 * (high - best), parameter.upper), points
    )
    curve = np.array([rise(v) for v in values])
    lower_open = any(is_open for (_, is_open), _ in ends)
    upper_open = any(is_open for _, (_, is_open) in ends)
    return Profile(parameter.name, best, parts, lower_open, upper_open, values, curve)


def _united(intervals: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """The same values in intervals that do not touch, in rising order."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(intervals):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return tuple(found)


def _least_squares_at(
    predict: Predict,
    measured: Float[np.ndarray, " n"],
    parameters: Sequence[Parameter],
    fit: Fit,
    name: str,
    value: float,
) -> float:
    """Least sum of squares with one parameter held at a value."""
    held = [replace(p, start=value, lower=value, upper=value, fixed=True) if p.name == name else p for p in parameters]

    def with_it(values: Mapping[str, float]) -> list[Float[np.ndarray, "_ c"]]:
        return predict({**values, name: value})

    size = np.array([max(float(np.sqrt(np.mean(measured**2))), np.finfo(float).tiny)])
    found = least_squares(with_it, [measured[:, None]], held, size, [fit.values])
    return float(found.residuals[0][:, 0] @ found.residuals[0][:, 0])


def _end(rise: Callable[[float], float], best: float, step: float, parameter: Parameter) -> tuple[float, bool]:
    """Where the profile reaches the cut in the direction of `step`, and whether it does not before the bound."""
    limit = parameter.lower if step < 0.0 else parameter.upper
    near, far = best, best
    for _ in range(DOUBLINGS):
        far = best + step
        if (far - limit) * step >= 0.0:
            far = limit
        if rise(far) >= 1.0:
            return float(brentq(lambda v: rise(v) - 1.0, near, far, xtol=1e-9 * abs(step), rtol=1e-10)), False
        if far == limit:
            return limit, True
        near, step = far, 2.0 * step
    return far, True

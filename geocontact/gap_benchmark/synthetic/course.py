"""Inputs as functions of time: prescribed ones exactly, measured ones by a cubic spline through the samples.

And what prescribed movements are made of: rounded polylines, steps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

KNOTS = 0.002
"""Spacing of the nodes through which prescribed but not closed-form movements run [s]."""


@dataclass(frozen=True)
class InputCourse:
    """Inputs along a time grid with two derivatives, one row per input, SI.

    `duration` is that of the trial; `phase` in 0..2 pi differs from trial to trial and no model can know it;
    `setting` holds the trial's covariates.
    """

    time: Float[np.ndarray, " t"]
    position: Float[np.ndarray, "i t"]
    rate: Float[np.ndarray, "i t"]
    acceleration: Float[np.ndarray, "i t"]
    duration: float
    phase: float = 0.0
    setting: Mapping[str, float] = field(default_factory=dict)


Path = Callable[[Float[np.ndarray, " t"]], InputCourse]
"""A movement: its course along any time grid."""


def through(
    time: Float[np.ndarray, " s"],
    rows: Float[np.ndarray, "i s"],
    duration: float,
    phase: float,
    setting: Mapping[str, float] | None = None,
) -> Path:
    """Path through samples."""
    spline = CubicSpline(time, rows, axis=1)

    def along(grid: Float[np.ndarray, " t"]) -> InputCourse:
        return InputCourse(grid, spline(grid), spline(grid, 1), spline(grid, 2), duration, phase, setting or {})

    return along


def logistic(u: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """1/(1 + exp(-u))."""
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * u)))


def smoothed(
    nodes: Float[np.ndarray, " n"], values: Float[np.ndarray, " n"], at: Float[np.ndarray, " t"], width: float
) -> Float[np.ndarray, " t"]:
    """Polyline with its corners rounded: the mean of it over a bell of `width`."""
    bell = np.linspace(-2.5, 2.5, 21)
    weight = np.exp(-0.5 * bell**2)
    lines = np.interp(at[:, None] + width * bell, nodes, values)
    return np.asarray(lines @ weight / weight.sum())


def reached(share: Float[np.ndarray, " t"], begin: float, end: float) -> Float[np.ndarray, " t"]:
    """0 before, 1 after, and least jerk between."""
    u = np.clip((share - begin) / (end - begin), 0.0, 1.0)
    return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u * u))

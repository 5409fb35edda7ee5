"""Inputs as functions of time: prescribed ones exactly, measured ones by a cubic spline through the samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline


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

"""Largest force of many people in the same kind of exoskeleton, each with numbers of their own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift
from geocontact.axis_misalignment.compensation import beyond
from geocontact.axis_misalignment.planar_joint import SOUND, STEP, extremes_of, grid

QUANTITIES = ("k", "l", "z", "x", "y")
"""Stiffness [N/m], link length, distance of the attachment, offsets [m]: columns of a sample."""


@dataclass(frozen=True, eq=False)
class Exposure:
    """What all of them do: range of angles [rad], stroke ends [m], drift."""

    start: float
    stop: float
    lower: float = 0.0
    upper: float = 0.0
    drift: AxisDrift = STILL


def peak_forces(
    people: Float[np.ndarray, "n 5"], exposure: Exposure, step: float = STEP
) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Largest |F| [N] of each person (columns as `QUANTITIES`), and what became of the joint.

    Infinite for a pole, a fold or a joint without an angle: there is no force that would hold it. `step` [rad] is that
    of the grid of angles before each extreme is refined; the error falls with its fourth power.
    """
    value, _, fate = extremes_of(
        grid(exposure.start, exposure.stop, step), np.ascontiguousarray(people[:, 1:]), exposure.drift
    )
    force = people[:, 0] * beyond(value, exposure.lower, exposure.upper)
    return np.where(fate == SOUND, force, np.inf), fate

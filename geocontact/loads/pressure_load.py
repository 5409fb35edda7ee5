"""Pressures on the pieces of a surface as one force, one moment and one centre, for all of it and for its parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.wrench import Wrench
from geocontact.loads.resultant import resultant, weighted_centre


@dataclass(frozen=True)
class PressureLoad:
    """What a pressure does to the body that it presses on.

    Parameters
    ----------
    pressing
        Sum of pressure times area [N], whichever way the pieces look; not smaller than the force.
    wrench
        Force [N] and moment [N m] about the origin of the frame.
    centre
        Centre of pressure, pieces weighted with pressure times area [m]; NaN where nothing presses.
    area
        Of the pieces under pressure [m^2].
    peak
        Largest pressure [Pa].
    """

    pressing: float
    wrench: Wrench
    centre: Float[np.ndarray, " 3"]
    area: float
    peak: float


def pressure_load(
    pressure: Float[np.ndarray, " n"],
    area: Float[np.ndarray, " n"],
    normal: Float[np.ndarray, "n 3"],
    point: Float[np.ndarray, "n 3"],
    frame: str,
) -> PressureLoad:
    """Load of `pressure` >= 0 [Pa] on pieces of `area` [m^2] at `point` [m] with outward unit `normal`.

    It acts against the normal: pressure pushes into the body.
    """
    weight = pressure * area
    loaded = pressure > 0.0
    force = resultant(-weight[:, None] * normal, point, frame)
    centre = weighted_centre(point, weight, "centre of pressure") if loaded.any() else np.full(3, np.nan)
    return PressureLoad(float(weight.sum()), force, centre, float(area[loaded].sum()), float(pressure.max(initial=0.0)))


def compartment_loads(
    pressure: Float[np.ndarray, " n"],
    area: Float[np.ndarray, " n"],
    normal: Float[np.ndarray, "n 3"],
    point: Float[np.ndarray, "n 3"],
    frame: str,
    parts: Mapping[str, Bool[np.ndarray, " n"]],
) -> dict[str, PressureLoad]:
    """`pressure_load` of each part, such as the medial and the lateral pieces."""
    return {
        name: pressure_load(pressure[which], area[which], normal[which], point[which], frame)
        for name, which in parts.items()
    }

"""Coordinates as OpenSim's files have them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.joint import Coordinate


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return np.asarray(values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates]))

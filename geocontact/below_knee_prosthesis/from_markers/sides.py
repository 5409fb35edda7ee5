"""A left prosthesis as a right one."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.from_markers.marker_names import mirrored_name
from geocontact.below_knee_prosthesis.model.leg import Side
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories

MIRROR = np.array([1.0, 1.0, -1.0])
"""Of vectors at the plane z = 0; moments change sign besides."""


def as_right(markers: MarkerTrajectories, side: Side) -> MarkerTrajectories:
    """Markers of a person with a left prosthesis mirrored, left and right exchanged; others as they are."""
    if side == "right":
        return markers
    names = tuple(mirrored_name(name) for name in markers.names)
    return MarkerTrajectories(markers.time, markers.positions * MIRROR, names, markers.source)


def of_side(vectors: Float[np.ndarray, "*t 3"], side: Side) -> Float[np.ndarray, "*t 3"]:
    """Places or forces of a right leg as those of the person's own side, and the other way round."""
    return vectors if side == "right" else vectors * MIRROR

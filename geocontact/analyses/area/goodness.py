"""Whether a contact area is one of contact: within a threshold that holds all faces it is the area of the body."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.surface import Surface
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_range

ALL = 0.999
"""Share of the area of the faces that count."""


def goodness_of_areas(
    name: str,
    bodies: Iterable[tuple[str, Surface, Bool[np.ndarray, " m"] | None, Float[np.ndarray, "t k"]]],
    thresholds: Float[np.ndarray, " k"],
) -> GoodnessOfFit:
    """Areas of one motion beside those of all faces that count.

    Parameters
    ----------
    name
        Of the motion, "" where there is one.
    bodies
        FIXED and MOVING: what it is called, its surface, the faces that count (None for all), areas [m^2].
    thresholds
        [m].

    A closed surface has a far side: there it contradicts that the area is one of contact. An open one, or a region, may
    be the part that touches.
    """
    doubts: list[Doubt] = []
    label = f"{name}: " if name else ""
    for called, surface, faces, areas in bodies:
        whole = float(surface.face_area[slice(None) if faces is None else faces].sum())
        for k, threshold in enumerate(thresholds):
            share = float(np.mean(areas[:, k] >= ALL * whole))
            what = f"{label}the area of {called} within {1e3 * threshold:g} mm is that of all its faces for"
            far = surface.closed and faces is None
            doubts += [Doubt(each.what, each.contradicts and far, share) for each in of_range(what, share)]
    return GoodnessOfFit(tuple(doubts), (f"{label}area",))

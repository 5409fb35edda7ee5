"""How far a surface rises over its own faces, as far as it has been asked for; what bounds of depth and gap rest on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.surface import Surface

USUAL = 0.9
"""Share of the other surface's faces that are small enough to be bounded without being divided."""

BEYOND = 1.5
"""Radius beyond a face in edges of the other surface: one that leads away from it and half a one for the gap."""


@dataclass(frozen=True, eq=False)
class Rise:
    """Heights of a surface over the planes of its faces, filled in by the kernels that need them.

    What stands there depends on the surface and the radius alone, so threads may share it in any order.

    place (m,) is the place of each slot in the tree; above and below (m,) are what `rise_of` gives on either side, NaN
    where it has not been asked for; reach is how far the radius goes beyond each face [m]. With `signed` what is free
    above is known to be outside.
    """

    place: Int[np.ndarray, " m"]
    above: Float[np.ndarray, " m"]
    below: Float[np.ndarray, " m"]
    reach: float
    signed: bool

    @classmethod
    def of(cls, surface: Surface, other: Surface) -> Rise:
        """Nothing known yet of `surface`, for bounds over the faces of `other`."""
        slots, count = surface.tree.slots, len(surface.faces)
        place = np.empty(count, np.int64)
        place[slots] = np.arange(len(slots))
        usual = float(np.quantile(other.edge_length.max(axis=1), USUAL))
        return cls(
            place=place,
            above=np.full(count, np.nan),
            below=np.full(count, np.nan),
            reach=BEYOND * usual,
            signed=surface.closed and surface.normals_trusted,
        )

"""A plane that divides a surface into two sides: medial and lateral, anterior and posterior."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Plane:
    """All x with normal . x = offset; normal a unit vector, offset in m, both in the surface's frame.

    >>> import geocontact as gc, numpy as np
    >>> gc.Plane.across("z", 0.01).height(np.array([[0.0, 0.0, 0.03]])).round(6).tolist()
    [0.02]
    """

    normal: tuple[float, float, float]
    offset: float = 0.0

    def height(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Signed distance of points to the plane [m]."""
        return np.asarray(points @ np.asarray(self.normal) - self.offset)

    @classmethod
    def across(cls, axis: str, at: float = 0.0) -> Plane:
        """Plane perpendicular to coordinate axis "x", "y" or "z" at coordinate `at` [m]."""
        if axis not in ("x", "y", "z"):
            raise ValueError(f"axis must be x, y or z, not {axis!r}")
        x, y, z = (1.0 if axis == name else 0.0 for name in "xyz")
        return cls((x, y, z), at)

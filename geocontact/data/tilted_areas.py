"""Areas of one motion with the moving body turned by some offsets of adduction, and by any offset between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator


@dataclass(frozen=True, eq=False)
class TiltedAreas:
    """Area over time and threshold at each offset.

    Parameters
    ----------
    offsets
        (a,) [rad], strictly increasing, at least two; the turn is about one axis of the fixed body's frame.
    area
        (t, k, a) [m^2].
    """

    offsets: Float[np.ndarray, " a"]
    area: Float[np.ndarray, "t k a"]

    @cached_property
    def _between(self) -> PchipInterpolator:
        return PchipInterpolator(self.offsets, self.area, axis=2)

    def at(self, offset: float) -> Float[np.ndarray, "t k"]:
        """Area with the body turned by `offset`: monotone cubic between those that were evaluated, held beyond them."""
        inside = float(np.clip(offset, self.offsets[0], self.offsets[-1]))
        return np.asarray(self._between(inside), float)

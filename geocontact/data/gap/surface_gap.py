"""Where on the surface a gap lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class SurfaceGap:
    """One channel's gap over the cells of its site.

    Parameters
    ----------
    site, channel, ids, place
        Of the cells; middles in the scan's frame [m].
    load, gap
        Part of each cell in the base model's force and in the gap; either adds up to 1.
    holding
        The fewest cells that hold 70 % of the gap, the fullest first.
    p_value
        That a gap spread as the load is would differ so much from that spread, family-wise over the cells.
    """

    site: str
    channel: str
    ids: tuple[str, ...]
    place: Float[np.ndarray, "n 3"]
    load: Float[np.ndarray, " n"]
    gap: Float[np.ndarray, " n"]
    holding: tuple[str, ...]
    p_value: float

    @property
    def held(self) -> tuple[float, float]:
        """What those cells hold of the gap, and of the load."""
        which = [self.ids.index(name) for name in self.holding]
        return float(self.gap[which].sum()), float(self.load[which].sum())

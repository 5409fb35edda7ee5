"""Where a centre of pressure lies on its plate: what unit, origin or order of channels is wrong shows there."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

OUTSIDE = 0.2
"""Of a plate's length, beyond its edge: farther off, the median centre of pressure is warned of."""

FAR = 1.0
"""Of a plate's length, beyond its edge: farther off, the plate cannot be used."""

HEAVY = 0.2
"""Share of the largest force from which samples count: below it the centre of pressure is not sharp."""


def lengths_outside(
    centre: Float[np.ndarray, "t 3"], load: Float[np.ndarray, " t"], corners: Float[np.ndarray, "4 3"], gate: float
) -> float:
    """Median distance of the loaded centre of pressure beyond the plate's edge, in its lengths; below 0 inside.

    Parameters
    ----------
    centre
        Centre of pressure [m], NaN where there is none.
    load
        Normal force [N].
    corners
        Of the surface [m], one after another around it.
    gate
        Normal force [N] from which a sample counts, at least.

    NaN for a plate that is never loaded.
    """
    heavy = (load >= max(gate, HEAVY * float(load.max()))) & np.isfinite(centre).all(axis=1)
    if not heavy.any():
        return float("nan")
    a, b, c, d = corners
    edges = np.stack([(a - b + d - c) / 2.0, (a - d + b - c) / 2.0])
    along = (centre[heavy] - corners.mean(axis=0)) @ edges.T / np.sum(edges**2, axis=1)
    return float(np.median(np.abs(along).max(axis=1)) - 0.5)

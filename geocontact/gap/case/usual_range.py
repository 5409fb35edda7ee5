"""The range that nearly all values of a recording are in."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap.levels import SLIGHT


def usual_range(values: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """Ends of the range that all but `SLIGHT` of the values lie in, half of the others beyond either; NaN do not count.

    In the unit of `values`.
    """
    low, high = np.nanquantile(values, [0.5 * SLIGHT, 1.0 - 0.5 * SLIGHT])
    return float(low), float(high)

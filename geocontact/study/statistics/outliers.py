"""Trials whose curve lies apart from the others of its condition.

The distance of a curve is the root mean square of what it lies off the median curve of its condition. It is called
apart where its modified z score, 0.6745 (d - median d) / MAD, is above 3.5: Iglewicz and Hoaglin (1993), "How to
detect and handle outliers", ASQC Quality Press, sec. 3.3.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

LIMIT = 3.5
LEAST = 5
"""Trials of a condition: of fewer none can be told to lie apart."""


def scores(curves: Float[np.ndarray, "n t"]) -> Float[np.ndarray, " n"]:
    """Modified z score of each curve's distance; 0 where there are fewer than five, or no curve is off the others."""
    there = np.isfinite(curves).all(axis=1)
    found = np.zeros(len(curves))
    if there.sum() < LEAST:
        return found
    own = curves[there]
    distance = np.sqrt(((own - np.median(own, axis=0)) ** 2).mean(axis=1))
    off = distance - np.median(distance)
    mad = float(np.median(np.abs(off)))
    if mad > 0.0:
        found[there] = 0.6745 * off / mad
    return found

"""How far two curves are apart."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def rms_difference(first: Float[np.ndarray, " t"], second: Float[np.ndarray, " t"]) -> float:
    """Root mean square of the difference where both have a value; NaN where they never do."""
    there = np.isfinite(first) & np.isfinite(second)
    return float(np.sqrt(np.mean((first[there] - second[there]) ** 2))) if there.any() else float("nan")

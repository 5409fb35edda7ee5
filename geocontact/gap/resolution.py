"""The steps that a recorder writes values in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float


def resolution(columns: Sequence[Float[np.ndarray, " _"]]) -> float:
    """Smallest step that nearly all differences are multiples of; 0 where there is none."""
    if not columns:
        return 0.0
    moves = np.abs(np.concatenate([np.diff(x) for x in columns]))
    moves = moves[moves > 0.0]
    if len(moves) < 8:
        return 0.0
    unit = float(np.quantile(moves, 0.02))
    for _ in range(20):
        units = moves / unit
        if (np.abs(units - np.round(units)) < 0.1).mean() > 0.9:
            return unit
        unit = float(np.median(moves[units < 1.5])) if (units < 1.5).sum() > 8 else 0.0
        if unit <= 0.0 or np.isclose(unit, np.quantile(moves, 0.02)):
            return 0.0
    return 0.0

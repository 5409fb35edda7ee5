"""The steps that a recorder writes values in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.gap.levels import FEWEST, SLIGHT

MOST = 10  # steps that a small difference may be


def resolution(columns: Sequence[Float[np.ndarray, " _"]]) -> float:
    """Step that nearly all differences are multiples of; 0 where there is none.

    The small ones among them may be a few steps, where a channel hardly rests.
    """
    if not columns:
        return 0.0
    moves = np.abs(np.concatenate([np.diff(x) for x in columns]))
    moves = moves[moves > 0.0]
    if len(moves) < FEWEST:
        return 0.0
    small = float(np.quantile(moves, SLIGHT, method="lower"))
    for parts in range(1, MOST + 1):
        units = moves / small * parts
        if (np.abs(units - np.round(units)) > 0.1).mean() < 0.1:
            return small / parts
    return 0.0

"""Recordings of which one is a copy of another: a file that was copied, or given twice under two names."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np
from jaxtyping import Float

FEWEST = 5
"""Samples from which two recordings that are alike are no chance."""


def same_recordings(recordings: Mapping[str, Float[np.ndarray, "*shape"]]) -> list[tuple[str, str]]:
    """Names of two recordings that have the same values, sample by sample, whatever their times; noise never does."""
    return [
        (first, second)
        for first, second in combinations(recordings, 2)
        if len(recordings[first]) >= FEWEST
        and recordings[first].shape == recordings[second].shape
        and np.array_equal(recordings[first], recordings[second], equal_nan=True)
    ]

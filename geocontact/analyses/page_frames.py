"""Which frames of a long recording a page shows."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

FRAMES = 1001
"""Shown at most; longer recordings are thinned out."""


def thinned(count: int) -> Int[np.ndarray, " k"]:
    """Every so manieth of `count` frames, the first among them."""
    return np.arange(0, count, -(-count // FRAMES))

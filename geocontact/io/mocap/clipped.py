"""Channels at the end of their converter: equal counts in a row at a limit of 12, 14 or 16 bits."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

RUN = 3
"""Samples in a row at the limit that are no chance."""

BITS = (12, 14, 16)
"""Of converters, where the file does not say."""

_WHOLE = 0.02  # of a count; files hold single precision


def clipped_runs(
    counts: Float[np.ndarray, "t c"], offset: Float[np.ndarray, " c"], bits: int
) -> Int[np.ndarray, "r 3"]:
    """Channel, first sample and length of every run of samples at the end of the converter.

    Parameters
    ----------
    counts
        As the converter gave them, before offset and scale; channels whose counts are not whole are passed over.
    offset
        Count that means nothing; where it is above 0, counts may begin at 0.
    bits
        Of the converter; 0 where the file does not say.
    """
    found = []
    for channel, column in enumerate(counts.T):
        if not len(column) or not (np.isfinite(column).all() and np.abs(column - np.round(column)).max() < _WHOLE):
            continue
        whole = np.round(column).astype(np.int64)
        limits = _limits((bits,) if bits in range(8, 33) else BITS, bool(offset[channel] > 0.0))
        for extreme in {int(whole.max()), int(whole.min())} & limits:
            edges = np.flatnonzero(np.diff(np.concatenate([[0], whole == extreme, [0]])))
            found += [(channel, start, end - start) for start, end in edges.reshape(-1, 2) if end - start >= RUN]
    return np.array(found, np.int64).reshape(-1, 3)


def _limits(widths: tuple[int, ...], from_zero: bool) -> set[int]:
    ends = {0} if from_zero else set[int]()
    for width in widths:
        half = 1 << (width - 1)
        ends |= {half - 1, -half, 1 - half, 2 * half - 1}
    return ends

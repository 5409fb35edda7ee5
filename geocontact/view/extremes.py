"""Long recordings in few samples: the smallest and the largest of each stretch stay, so that no peak is lost."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.frame_blocks import blocks, release

FRAMES = 1001
"""Samples of a recording that a page shows at most, about; so many go into the width of a curve."""

FEWEST = 50
"""Stretches below which curves are too coarse: rather fewer curves keep their extremes in each of them."""


def with_extremes(
    count: int, curves: Sequence[Float[np.ndarray, " t"]], most: int = FRAMES, always: Iterable[int] = ()
) -> Int[np.ndarray, " k"]:
    """Samples that stand for all `count`, in rising order: all of them where these are no more than `most`.

    Else both ends, `always`, the largest and the smallest value of every curve, and those of each of as many equal
    stretches as there is room for. Where many curves leave room for few stretches, the first of them have that only.

    Parameters
    ----------
    curves
        Values at all samples, the most important one first; NaN is passed over.
    always
        Samples that are kept besides.
    """
    if count <= most:
        return np.arange(count)
    known = [curve for curve in curves if np.isfinite(curve).any()]
    ends = [int(find(_known(curve))) for curve in known[: most // 4] for find in (np.nanargmin, np.nanargmax)]
    kept = np.unique(np.array([0, count - 1, *map(int, always), *ends]))
    leading = known
    while leading:
        found = _of_most_stretches(kept, leading, most)
        if found is not None:
            kept = found
            break
        leading = leading[: len(leading) // 2]
    spare = most - len(kept)
    if spare > most // 2:  # little is known, or no curve is there: the rest evenly
        kept = np.union1d(kept, np.linspace(0, count - 1, spare).astype(int))
    return kept


def thinned_line(
    x: Float[np.ndarray, " t"], y: Float[np.ndarray, " t"], most: int = 2 * FRAMES
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
    """A line for a figure: as it is, or its extremes in each stretch; gaps (NaN) wider than a stretch stay."""
    edges = np.flatnonzero(np.diff(np.isfinite(y).astype(int)))[: most // 8]
    kept = with_extremes(len(y), [y], most, [*edges.tolist(), *(edges + 1).tolist()])
    return x[kept], y[kept]


def _of_most_stretches(
    kept: Int[np.ndarray, " k"], curves: Sequence[Float[np.ndarray, " t"]], most: int
) -> Int[np.ndarray, " n"] | None:
    """With the extremes of as many stretches as there is room for; None where that are fewer than `FEWEST`."""
    stretches = most // 2
    while stretches >= FEWEST:
        found = np.unique(np.concatenate([kept, *(_of_stretches(curve, stretches) for curve in curves)]))
        if len(found) <= most:
            return found
        stretches = min(int(stretches * most / len(found)), int(0.97 * stretches))
    return None


def _of_stretches(curve: Float[np.ndarray, " t"], stretches: int) -> Int[np.ndarray, " e"]:
    """Where a curve is least and largest in each of so many equal stretches in which it is known."""
    starts = np.linspace(0, len(curve), stretches + 1).astype(int)
    longest = int(np.diff(starts).max())
    found = []
    for some in blocks(stretches, longest):
        at = np.minimum(starts[:-1][some, None] + np.arange(longest), starts[1:][some, None] - 1)
        values = _known(curve[at])
        there = np.isfinite(values).any(axis=1)
        at, values = at[there], values[there]
        found += [at[np.arange(len(at)), find(values, axis=1)] for find in (np.nanargmin, np.nanargmax)]
        release()
    return np.concatenate(found)


def _known(curve: Float[np.ndarray, "*t"]) -> Float[np.ndarray, "*t"]:
    """NaN for what is endless too."""
    return np.where(np.isfinite(curve), curve, np.nan)

"""Which frames of a long recording a page shows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.extremes import FRAMES, with_extremes


def thinned(
    count: int, curves: Sequence[Float[np.ndarray, " t"]] = (), always: Iterable[int] = (), most: int = FRAMES
) -> Int[np.ndarray, " k"]:
    """Of `count` frames at most about `most`: those with the extremes of the curves; every so manieth without curves.

    `always` are frames that are kept besides.
    """
    if len(curves):
        return with_extremes(count, curves, most, always)
    return np.unique([*range(0, count, -(-count // most)), *always]).astype(np.int64)

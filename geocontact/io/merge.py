"""Vertices of a file to vertices of a surface: coincident ones become one, unused ones go."""

from __future__ import annotations

import warnings

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputWarning


def merge_coincident(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], file: str
) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "m 3"]]:
    """One vertex for all that are equal to the last bit; −0 equals 0.

    Faces keep their order and corners, vertices the order in which they first appear. Vertices that no face uses are
    left out with a warning. `vertices` must be finite.
    """
    vertices = vertices + vertices.dtype.type(0)  # −0 + 0 is +0
    order = np.lexsort(vertices.T)
    opens = np.zeros(len(order), dtype=bool)  # whether a vertex differs from the one before it in that order
    opens[:1] = True
    for column in vertices.T:
        ranked = column[order]
        opens[1:] |= ranked[1:] != ranked[:-1]
    first = order[opens].astype(np.int32)  # the sort is stable: the first of equals has the smallest index
    representative = np.empty(len(order), dtype=np.int32)
    representative[order] = first[np.cumsum(opens, dtype=np.int32) - 1]
    del order, opens, ranked
    used = np.zeros(len(vertices), dtype=bool)
    used[representative[faces]] = True
    unused = len(first) - int(np.count_nonzero(used))
    if unused:
        noun = "vertices belong" if unused > 1 else "vertex belongs"
        warnings.warn(InputWarning(f"{file}: {unused} {noun} to no face, left out"), stacklevel=3)
    number = np.cumsum(used, dtype=np.int32) - 1
    return vertices[used], number[representative][faces].astype(np.int64)

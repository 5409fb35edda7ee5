"""Vertices of a file to vertices of a surface: coincident ones become one, unused ones go."""

from __future__ import annotations

import warnings

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.coincident import first_of_coincident
from geocontact.data.errors import InputWarning


def merge_coincident(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], file: str
) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "m 3"]]:
    """One vertex for all that are equal to the last bit; −0 equals 0.

    Faces keep their order and corners, vertices the order in which they first appear. Vertices that no face uses are
    left out with a warning. `vertices` must be finite.
    """
    vertices = vertices + vertices.dtype.type(0)  # −0 + 0 is +0
    representative = first_of_coincident(vertices)
    used = np.zeros(len(vertices), dtype=bool)
    used[representative[faces]] = True
    distinct = np.count_nonzero(representative == np.arange(len(vertices)))
    unused = int(distinct - np.count_nonzero(used))
    if unused:
        noun = "vertices belong" if unused > 1 else "vertex belongs"
        warnings.warn(InputWarning(f"{file}: {unused} {noun} to no face, left out"), stacklevel=3)
    number = np.cumsum(used, dtype=np.int32) - 1
    return vertices[used], number[representative][faces].astype(np.int64)

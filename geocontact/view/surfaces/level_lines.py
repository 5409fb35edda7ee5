"""Lines of equal value on a triangle surface."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int


def level_lines(
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    values: Float[np.ndarray, " n"],
    level: float,
) -> tuple[Float[np.ndarray, "s 2 3"], Int[np.ndarray, " s"]]:
    """Segments along which linearly interpolated `values` equal `level`, and the face that each lies in.

    A value equal to the level counts as below it, as in the area. Faces with a corner of infinite value have no line.
    """
    crossed = np.isfinite(values[faces]).all(axis=1)
    below = values[faces] <= level
    crossed &= below.any(axis=1) & ~below.all(axis=1)
    index = np.flatnonzero(crossed)
    corners, below = faces[index], below[index]
    odd = np.where(below.sum(axis=1) == 1, below.argmax(axis=1), (~below).argmax(axis=1))  # the corner on its own side
    rows = np.arange(len(index))
    alone = corners[rows, odd]
    ends = []
    for step in (1, 2):
        other = corners[rows, (odd + step) % 3]
        share = (level - values[alone]) / (values[other] - values[alone])
        ends.append(vertices[alone] + share[:, None] * (vertices[other] - vertices[alone]))
    return np.stack(ends, axis=1), index

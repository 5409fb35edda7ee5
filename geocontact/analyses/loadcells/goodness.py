"""Whether load cells read what they can: a knee presses on its tray, and a cell at its end only says "more"."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_range

SLIGHT = 0.01
"""Share of the largest force; less tension than that is an offset not worth a word."""
FLAT = 10
"""Samples in a row at the very same largest value; noise of a cell that is not at its end makes them differ."""


def goodness_of_cells(
    name: str, total: Float[np.ndarray, " t"], cells: Mapping[str, Float[np.ndarray, " t"]]
) -> GoodnessOfFit:
    """One recording: its total force, and every cell by name [N]."""
    largest = float(np.nanmax(np.abs(total), initial=0.0))
    doubts: list[Doubt] = []
    if largest > 0.0:
        pulled = float(np.mean(total < -SLIGHT * largest))
        doubts += of_range(f"{name}: the knee pulls on its tray for", pulled)
        for cell, values in cells.items():
            clipped = float(np.mean(at_its_end(values)))
            doubts += of_range(f"{name}: {cell} stays at its largest value for", clipped)
    return GoodnessOfFit(tuple(doubts), (name, *cells))


def at_its_end(values: Float[np.ndarray, " t"]) -> np.ndarray:
    """Samples of runs of `FLAT` or more at the largest value, above zero.

    >>> at_its_end(np.r_[np.arange(5.0), np.full(12, 5.0)]).sum(), at_its_end(np.arange(20.0)).sum()
    (np.int64(12), np.int64(0))
    """
    top = values == np.nanmax(values)
    if not np.nanmax(values) > 0.0:
        return np.zeros(len(values), bool)
    edges = np.flatnonzero(np.diff(np.r_[False, top, False]))
    runs = [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a >= FLAT]
    found = np.zeros(len(values), bool)
    for first, last in runs:
        found[first:last] = True
    return found

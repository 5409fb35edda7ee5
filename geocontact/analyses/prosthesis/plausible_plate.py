"""What a force plate under a walking person's foot can say, and when it can say so."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError

LEAST, MOST = 0.3, 5.0
"""Of the body weight, between which the largest vertical force of a step lies."""
BESIDE = 1.0
"""Lengths of the foot from its middle beyond which a centre of pressure is not its."""
APART = 0.06
"""s by which clocks may differ: a foot that hovers before it lands, and a plate's threshold, make up to that."""


def require_weight(file: Path, option: str, name: str, load: Float[np.ndarray, " t"], weight: float) -> None:
    """InputError for a vertical force [N] that no step of a person of that weight [N] makes."""
    most = float(np.max(load, initial=0.0)) / weight
    if LEAST <= most <= MOST:
        return
    what = f"the vertical force on {name} is {most:.3g} times body weight at most"
    raise InputError(file, option, what, "is it in N, `mass` in kg, and y up?")


def require_one_clock(file: Path, option: str, name: str, offset: float) -> None:
    """InputError where the plate is later than the markers by more than clocks on one time can differ [s]."""
    if abs(offset) > APART:
        what = (
            f"{name} is loaded {abs(offset):.2f} s {'after' if offset > 0.0 else 'before'} the markers touch the floor"
        )
        raise InputError(file, option, what, "markers and forces need one clock: shift one of them")


def require_under_foot(file: Path, name: str, centre: Float[np.ndarray, " t"]) -> None:
    """InputError where a centre of pressure is not under the foot; in lengths of the foot from its heel."""
    known = centre[np.isfinite(centre)]
    if not len(known) or np.median(np.abs(known - 0.5)) > BESIDE:
        what = f"no plate under the foot: the centre of pressure of {name} is not under it"
        raise InputError(file, "`plate`", what, "check frame, side and clock, and that this plate is meant")

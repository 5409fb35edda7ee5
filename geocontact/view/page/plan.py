"""A drawing to scale in a plane, seen from one direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class Track:
    """A point that moves over the frames; NaN is a gap.

    `told` is what the key says in each frame; where the point is, by default.
    """

    name: str
    points: Float[np.ndarray, "t 2"]
    told: Sequence[str] = ()


@dataclass(frozen=True, eq=False)
class Mark:
    """A named point that stands still."""

    name: str
    point: tuple[float, float]


@dataclass(frozen=True)
class Length:
    """A length between two points: `name` stands beside it, `told` (value, unit, how well it is known) in the key."""

    name: str
    told: str
    start: tuple[float, float]
    end: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Plan:
    """Lines, tracks, marks and lengths with one scale along both axes.

    Parameters
    ----------
    unit
        Of all lengths.
    across, up
        Names of the axes to the right and upwards: "x", "−z".
    lines
        Polylines that do not change, such as the outline of a body, each (k, 2).
    words
        What it shows.
    """

    title: str
    unit: str
    across: str
    up: str
    lines: Sequence[Float[np.ndarray, "_ 2"]] = ()
    tracks: Sequence[Track] = ()
    marks: Sequence[Mark] = ()
    lengths: Sequence[Length] = ()
    words: str = ""

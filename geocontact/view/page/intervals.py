"""Numbers with their intervals on one axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class IntervalRow:
    """A number and the interval that it is known to; NaN where there is none.

    `kind` tells numbers of the same name apart, by a colour of its own.
    """

    name: str
    value: float
    lower: float = float("nan")
    upper: float = float("nan")
    kind: str = ""


@dataclass(frozen=True, eq=False)
class Intervals:
    """Numbers of one unit below each other: as points with whiskers, or as bars from 0.

    Parameters
    ----------
    bars
        Shares and sizes, which are compared with 0.
    words
        What it shows.
    """

    title: str
    unit: str
    intervals: Sequence[IntervalRow]
    bars: bool = False
    words: str = ""

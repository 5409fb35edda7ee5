"""A number that a model needs: with its source, or to be identified from data."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Source = Literal["paper", "derived", "invented", "option"]
SOURCES: tuple[Source, ...] = ("paper", "derived", "invented")


@dataclass(frozen=True)
class Number:
    """A number in SI, where it is from, and why it is so."""

    value: float
    source: Source
    note: str = ""


DECADES = 100.0
"""Bounds farther apart than this factor: a parameter is thought of in its logarithm."""


@dataclass(frozen=True)
class Parameter:
    """Name, unit, and what is known of the value beforehand.

    Parameters
    ----------
    name, unit
        As in the model; the unit is a label and nothing is converted by it.
    start
        Where a search begins; the value itself when `fixed`.
    lower, upper
        Bounds of the search; infinite where there is none.
    fixed
        Known from elsewhere, not to be fitted.

    Examples
    --------
    >>> import geocontact as gc
    >>> stiffness = gc.Parameter("k", "N/m", 200.0, lower=50.0, upper=800.0)
    >>> stiffness.lower, stiffness.fixed
    (50.0, False)
    """

    name: str
    unit: str
    start: float
    lower: float = -math.inf
    upper: float = math.inf
    fixed: bool = False

    def __post_init__(self) -> None:
        if not math.isfinite(self.start):
            raise ValueError(f"{self.name}: start is {self.start}, expected a finite number")
        if not self.lower <= self.start <= self.upper:
            raise ValueError(f"{self.name}: start {self.start:g} is not between {self.lower:g} and {self.upper:g}")
        if not self.fixed and self.lower == self.upper:
            raise ValueError(f"{self.name}: lower and upper bound are equal; say fixed = true instead")

    @property
    def over_decades(self) -> bool:
        """Whether it is positive within finite bounds farther apart than `DECADES`: its range is no magnitude of it."""
        return self.lower > 0.0 and DECADES * self.lower < self.upper < math.inf

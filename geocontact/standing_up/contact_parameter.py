"""A number of a contact that trials may tell: its bounds, and what is believed of it beforehand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Vector = Float[np.ndarray, " p"]


@dataclass(frozen=True)
class ContactParameter:
    """A parameter, searched as itself or as the logarithm of its part of the usual value.

    Parameters
    ----------
    name, unit
        As tables call it.
    usual, sd
        Belief beforehand: mean in `unit`, standard deviation of what is searched.
    least, most
        Bounds in `unit`.
    logarithm
        Whether ln(value / usual) is searched.
    """

    name: str
    unit: str
    usual: float
    sd: float
    least: float
    most: float
    logarithm: bool = False

    def searched(self, value: float) -> float:
        """What stands for a value in the search."""
        return float(np.log(value / self.usual)) if self.logarithm else value

    def value(self, searched: float) -> float:
        """In `unit`."""
        return float(self.usual * np.exp(searched)) if self.logarithm else searched


def searched(parameters: Sequence[ContactParameter], values: Sequence[float]) -> Vector:
    """What stands for values in the search."""
    return np.array([each.searched(value) for each, value in zip(parameters, values, strict=True)])


def usual(parameters: Sequence[ContactParameter]) -> Vector:
    """Where a search starts: what is believed."""
    return searched(parameters, [each.usual for each in parameters])


def bounds(parameters: Sequence[ContactParameter], free: Sequence[str]) -> tuple[Vector, Vector]:
    """Of what is searched; both are the usual value where a parameter is not free. ValueError for a name not there."""
    unknown = set(free) - {each.name for each in parameters}
    if unknown:
        raise ValueError(f"there is no parameter {min(unknown)!r}")
    low, high = (
        searched(parameters, [getattr(p, side) if p.name in free else p.usual for p in parameters])
        for side in ("least", "most")
    )
    return low, high

"""Distances in 8 bits, with the threshold on an exact level; amounts in 8 bits from nothing to the largest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int, UInt8

BEYOND, DEEPEST = 255, 0
STEPS = 252


@dataclass(frozen=True)
class Levels:
    """Code c means the distance `first + (c - 1) step` [m]; 255 means farther than was asked, or unknown.

    Codes 1 … 254 cover the span and what lies across its upper end; what is deeper than its lower end has code 0 and is
    drawn like the lower end.
    """

    first: float
    step: float

    @classmethod
    def of(cls, span: tuple[float, float], threshold: float, across: float = 0.0) -> Levels:
        """Levels that cover `span` [m] and reach up to `across` [m], one of them `threshold` [m] to rounding."""
        step = (max(span[1], across) - span[0]) / STEPS
        below = int(np.ceil((threshold - span[0]) / step - 1e-9))
        return cls(threshold - below * step, step)

    @property
    def error(self) -> float:
        """Largest difference between a distance inside the span and its level [m]."""
        return 0.5 * self.step

    def codes(self, distance: Float[np.ndarray, "t n"]) -> UInt8[np.ndarray, "t n"]:
        """Nearest code of each distance [m]."""
        codes = np.empty(distance.shape, np.uint8)
        for row, values in zip(codes, distance, strict=True):  # row by row: a thousand frames need no second copy
            with np.errstate(invalid="ignore"):
                nearest = np.rint((values - self.first) / self.step) + 1.0
            nearest[np.isnan(nearest)] = BEYOND
            row[:] = np.clip(nearest, DEEPEST, BEYOND)
        return codes

    def distance(self, codes: UInt8[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
        """Distance of each code [m]; -inf and +inf for the ends."""
        distance = self.first + (codes.astype(float) - 1.0) * self.step
        distance[codes == BEYOND] = np.inf
        distance[codes == DEEPEST] = -np.inf
        return distance


@dataclass(frozen=True)
class AmountLevels:
    """Code c means the amount `c step`, 1 … 254; 255 means none."""

    step: float

    @classmethod
    def of(cls, upper: float) -> AmountLevels:
        """Levels up to the largest amount."""
        return cls(upper / (BEYOND - 1))

    @property
    def error(self) -> float:
        """Largest difference between an amount and its level; little ones are shown as the first level."""
        return self.step

    def codes(self, values: Float[np.ndarray, "t m"]) -> UInt8[np.ndarray, "t m"]:
        """Nearest code of each amount; what is above 0 is never shown as none."""
        nearest = np.clip(np.rint(values / self.step), 1.0, BEYOND - 1.0)
        return np.asarray(np.where(values > 0.0, nearest, float(BEYOND)).astype(np.uint8))


def across(faces: Int[np.ndarray, "m 3"], distance: Float[np.ndarray, "t n"], upper: float, most: float) -> float:
    """Largest distance on a face that also reaches below `upper` [m], no more than `most`.

    A contour at `upper` runs through such faces and would be displaced if their far corners were cut off.
    """
    largest = upper
    for values in distance:
        corners = values[faces[(values <= upper)[faces].any(axis=1)]]
        largest = max(largest, float(np.max(corners, initial=upper, where=corners <= most)))
    return largest

"""What an axis shows, in which unit, and what a figure refuses to draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from geocontact.view.curves.sheet import plain

WRAP = 32  # letters on a line of a label, which the height of a small figure has room for


@dataclass(frozen=True)
class Quantity:
    """Name and unit of an axis; `dataclasses.replace(AREA, name="medial contact area")` renames one.

    Parameters
    ----------
    name, unit
        As printed: "contact area [mm²]".
    per_si
        How many of `unit` one SI unit is: 1e6 for areas in mm².
    """

    name: str
    unit: str
    per_si: float = 1.0

    @property
    def label(self) -> str:
        """Label of an axis, on several lines if it is long."""
        return plain(f"{self.name} [{self.unit}]", WRAP)

    def shown(self, values: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """SI values as numbers in `unit`."""
        return np.asarray(values * self.per_si)


AREA = Quantity("contact area", "mm²", 1e6)
LENGTH = Quantity("distance", "mm", 1e3)
FORCE = Quantity("contact force", "N")
MOMENT = Quantity("moment", "N m")
PRESSURE = Quantity("contact pressure", "MPa", 1e-6)
ANGLE = Quantity("angle", "°", 180.0 / np.pi)
TIME = Quantity("time", "s")
CYCLE = Quantity("cycle", "%")  # positions in a cycle are percentages throughout, as in Motion.time of unit "%"


SERIES = 6  # how many lines are still distinguished by colour, line and marker


def array(name: str, values: ArrayLike, shape: tuple[int | str, ...]) -> Float[np.ndarray, "*shape"]:
    """`values` as float64 of `shape`, in which a word is a length that is not fixed; NaN is a missing sample."""
    try:
        found: Float[np.ndarray, "*shape"] = np.asarray(values, np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: not an array of numbers ({error})") from error
    wanted = f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"
    fits = all(isinstance(n, str) or n == m for n, m in zip(shape, found.shape, strict=False))
    if found.ndim != len(shape) or not fits:
        raise ValueError(f"{name}: shape {found.shape}, expected {wanted}")
    if found.size == 0:
        raise ValueError(f"{name}: no values, expected shape {wanted}")
    if np.isinf(found).any():
        raise ValueError(f"{name}: {np.isinf(found).sum()} infinite values; put NaN where a sample is missing")
    return found


def positions(along: Quantity, values: ArrayLike) -> Float[np.ndarray, " t"]:
    """Where the samples lie on the horizontal axis: strictly increasing, and percentages where `along` says so."""
    x = array(along.name, values, ("t",))
    if not (np.diff(x) > 0.0).all():  # also where one is NaN
        raise ValueError(f"{along.name}: not strictly increasing")
    if along.unit == "%" and (x[0] < 0.0 or x[-1] > 100.0 + 1e-9):
        raise ValueError(f"{along.name}: from {x[0]:g} to {x[-1]:g}, expected 0 to 100 %")
    if along.unit == "%" and len(x) > 1 and x[-1] <= 1.0:
        raise ValueError(f"{along.name}: ends at {x[-1]:g} %; fractions of a cycle times 100 are percentages")
    return x


def named(what: str, series: Mapping[str, ArrayLike], shape: tuple[int | str, ...]) -> dict[str, np.ndarray]:
    """Arrays by name, at least one and no more than can be distinguished."""
    if not series:
        raise ValueError(f"{what}: nothing to draw")
    if len(series) > SERIES:
        raise ValueError(f"{what}: {len(series)} of them, at most {SERIES} can be shown; draw several figures")
    return {name: array(f"{what} {name!r}", values, shape) for name, values in series.items()}


def finite(name: str, values: ArrayLike, least: int) -> Float[np.ndarray, " n"]:
    """The samples that are not missing, of which there must be `least`."""
    kept = array(name, values, ("n",))
    there = np.isfinite(kept)
    if there.sum() < least:
        raise ValueError(f"{name}: {there.sum()} values that are not NaN, expected at least {least}")
    return np.asarray(kept[there])

"""Units and sizes in an XSENSOR file: said once and in force from then on, or said anew above every frame."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Sequence

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.mats.layout import LARGEST, SMALLEST
from geocontact.io.mats.text import shown
from geocontact.io.mats.units import area_unit, length_unit, pressure_unit

Said = tuple[int, str, str]
"""Line, unit in brackets and value of a key."""

Keys = dict[str, Said]
"""By key, in lower case."""

SIZES = ("sensel width", "sensel height", "sensel area")

SAME = 1e-3
"""Relative difference below which two sizes are one, rounded in two units."""


def size_of(keys: Keys, key: str, unit_of: Callable[[str], float | None], file: str) -> float | None:
    """A positive length or area in SI; None without the key."""
    if key not in keys:
        return None
    line, unit, text = keys[key]
    factor = unit_of(unit)
    if factor is None:
        what = f"{key.title()} is in '{shown(unit)}', which is not a unit known here"
        raise InputError(file, f"line {line}", what, "export it in cm or in")
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        number = 0.0
    if not SMALLEST <= number <= LARGEST:
        raise InputError(file, f"line {line}", f"{key.title()} is '{shown(text)}'", "expected a positive number")
    return number * factor


def require_same_size(first: Keys, block: Keys, file: str) -> None:
    """The keys above a frame may not give its cells another size than those above the sensor's first frame."""
    for key, unit_of in zip(SIZES, (length_unit, length_unit, area_unit), strict=True):
        now, before = size_of(block, key, unit_of, file), size_of(first, key, unit_of, file)
        if now is not None and (before is None or not math.isclose(now, before, rel_tol=SAME)):
            had = "none" if before is None else shown(first[key][2])
            what = f"{key.title()} is {shown(block[key][2])} where the sensor's first frame has {had}"
            raise InputError(file, f"line {block[key][0]}", what, "export one size of cell")


def pascals(said: Said | None, file: str) -> float | None:
    """Per unit of pressure; None where nothing is said."""
    if said is None:
        return None
    line, _, text = said
    factor = pressure_unit(text)
    if factor is None:
        what = f"Units is '{shown(text)}', which is not a unit of pressure known here"
        raise InputError(file, f"line {line}", what, "export pressures, calibrated, in kPa")
    return factor


def in_one_unit(values: array[float], said: Sequence[Said | None], unit: float | None, file: str) -> array[float]:
    """Values of all frames in the unit of the first, `unit` [Pa].

    Frames whose own keys name another unit are converted where every frame names its unit; where some do not, it is
    open which they are in, and the file is refused at the line of the first other unit.
    """
    factors = [pascals(each, file) for each in said]
    other = next((each for each, factor in zip(said, factors, strict=True) if factor not in (None, unit)), None)
    if other is None:
        return values
    silent = factors.count(None)
    if silent or unit is None:
        what = f"Units is {shown(other[2])} and was not before, and {silent} frames of the sensor name none"
        remedy = "export the recording in one unit, or with Units above every frame"
        raise InputError(file, f"line {other[0]}", what, remedy)
    frames = np.frombuffer(values, dtype=np.float64).reshape(len(said), -1)
    return array("d", (frames * (np.array(factors, float) / unit)[:, None]).tobytes())

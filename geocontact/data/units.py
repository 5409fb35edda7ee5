"""Units where values enter: `mm(4)` is 0.004, in metres, as everything inside is in SI.

>>> mm(4)
0.004
>>> mm(1, 4)
(0.001, 0.004)
"""

from __future__ import annotations

from math import pi
from typing import overload

_FORCE_OF_A_POUND = 0.45359237 * 9.80665  # N, exact by definition
_PRESSURE_OF_MERCURY = 13595.1 * 9.80665 * 1e-3  # Pa per mm of conventional density (ISO 80000-4)


class Unit:
    """A unit that turns numbers into SI: called with one number it gives a float, with several a tuple.

    Parameters
    ----------
    name, si
        The unit, and the SI unit of what it gives.
    factor
        How many SI units it is.
    """

    def __init__(self, name: str, si: str, factor: float) -> None:
        self.name, self.si, self.factor = name, si, factor

    @overload
    def __call__(self, value: float | int, /) -> float: ...
    @overload
    def __call__(self, value: float | int, other: float | int, /, *more: float | int) -> tuple[float, ...]: ...
    def __call__(self, value: float | int, /, *more: float | int) -> float | tuple[float, ...]:
        """The values in SI."""
        if not more:
            return value * self.factor
        return tuple(each * self.factor for each in (value, *more))

    def __repr__(self) -> str:
        return f"<unit {self.name}: {self.factor:g} {self.si}>"


m, cm, mm, inch = (Unit(n, "m", f) for n, f in (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("in", 0.0254)))
deg = Unit("deg", "rad", pi / 180.0)
ms = Unit("ms", "s", 1e-3)
kN, lbf = Unit("kN", "N", 1e3), Unit("lbf", "N", _FORCE_OF_A_POUND)
kPa, MPa, GPa = (Unit(n, "Pa", f) for n, f in (("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)))
mmHg = Unit("mmHg", "Pa", _PRESSURE_OF_MERCURY)
percent = Unit("%", "-", 1e-2)
UNITS = (m, cm, mm, inch, deg, ms, kN, lbf, kPa, MPa, GPa, mmHg, percent)
"""All of them, each importable by its name."""

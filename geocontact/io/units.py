"""Units at the door: how many metres or radians one unit of a file is."""

from __future__ import annotations

import re
from math import pi

LENGTH: dict[str, float] = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "um": 1e-6}
"""Metres per unit of length."""

ANGLE: dict[str, float] = {"rad": 1.0, "deg": pi / 180.0}
"""Radians per unit of angle."""

MESH_UNITS = ("m", "cm", "mm", "in")
"""Units a mesh may be declared in; the keys of `LENGTH` that surfaces of implants and bodies come in."""

_HEADER = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?\s*")


def split_header(header: str) -> tuple[str, str]:
    """Name and unit of a column header: `"tx [mm]"` gives `("tx", "mm")`.

    The unit is empty when the header has none and is not checked against any table. Text that is not of the form
    `name [unit]` (unbalanced or repeated brackets) comes back whole as the name, without a unit.
    """
    match = _HEADER.fullmatch(header)
    if match is None:
        return header.strip(), ""
    return match["name"], (match["unit"] or "").strip()

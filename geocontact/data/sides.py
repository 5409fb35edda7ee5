"""Names of bodies, coordinates and markers that say a side of the body."""

from __future__ import annotations

import re

RIGHT, LEFT = "right", "left"
_SIDED = re.compile(r"(?P<stem>.+)_(?P<end>r|l|right|left)|(?P<begin>r|l|right|left)_(?P<rest>.+)", re.IGNORECASE)


def stem_and_side(name: str) -> tuple[str, str]:
    """`hip_flexion_r` to `hip_flexion` and "right"; "" for a name without a side."""
    found = _SIDED.fullmatch(name)
    if found is None:
        return name, ""
    side = (found["end"] or found["begin"]).lower()
    return found["stem"] or found["rest"], RIGHT if side.startswith("r") else LEFT


def differ_by_side(one: str, other: str) -> bool:
    """Whether two names differ by right and left alone, in one place: RASI and LASI, knee_r and knee_l."""
    a, b = one.lower().replace("right", "r"), other.lower().replace("left", "l")
    if "left" in one.lower() or "right" in other.lower():
        a, b = other.lower().replace("right", "r"), one.lower().replace("left", "l")
    differing = [{x, y} for x, y in zip(a, b, strict=False) if x != y]
    return len(a) == len(b) and differing == [{"r", "l"}]

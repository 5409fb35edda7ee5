"""Right and left in the names of coordinates, bodies and joints."""

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

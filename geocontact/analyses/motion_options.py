"""Motions that are prescribed instead of recorded, as an option. Light to import."""

from __future__ import annotations

from typing import Annotated

from geocontact.analyses.options import Spelled, Typed
from geocontact.data.plausible import JOINT_ANGLE

Sweep = Annotated[
    tuple[str, float, float, float],
    Typed("rad", "sweep_range", '("flexion", *gc.deg(0, 90, 1))'),
    Spelled(dashed=True),
    JOINT_ANGLE,
]
"""Name, start, stop and step."""

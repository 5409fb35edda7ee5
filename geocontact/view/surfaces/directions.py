"""Names for the directions from which one looks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float


def camera_directions(medial: Float[np.ndarray, " 3"]) -> Mapping[str, tuple[float, float, float]]:
    """View-from vectors in FIXED's frame, named by its axes; anatomy is named where the caller knows it.

    Meshes do not say which way their axes point in the body: public data of implants that are described with x anterior
    have x posterior, and y is superior in a knee and not in a scan of a foot. What is known is what was asked for: the
    medial direction, and lateral opposite to it.

    Parameters
    ----------
    medial
        Unit vector towards medial in FIXED's frame; zero when it is not known.
    """
    ways = [(s * float(k == 0), s * float(k == 1), s * float(k == 2)) for k in range(3) for s in (1, -1)]
    names = {way: _axis(*way) for way in ways}
    towards = tuple(float(value) for value in medial)
    if any(towards):
        x, y, z = towards
        opposite = (0.0 - x, 0.0 - y, 0.0 - z)
        sides = {(x, y, z): f"medial ({_axis(x, y, z)})", opposite: f"lateral ({_axis(*opposite)})"}
        names = {**sides, **{way: name for way, name in names.items() if way not in sides}}
    return {name: way for way, name in names.items()}


def _axis(x: float, y: float, z: float) -> str:
    """+x, −z, … for a coordinate axis, the numbers for anything else."""
    for name, value in zip("xyz", (x, y, z), strict=True):
        if abs(value) == 1.0:
            return ("+" if value > 0.0 else "−") + name
    return f"{x:.2f}, {y:.2f}, {z:.2f}"

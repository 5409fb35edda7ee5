"""Names for the directions from which one looks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float


def camera_directions(medial: Float[np.ndarray, " 3"]) -> Mapping[str, tuple[float, float, float]]:
    """View-from vectors in FIXED's frame, named after anatomy where the frame is known, with the axis in each name.

    y is taken for superior as long as nothing speaks against it. x and z are named by their axes alone: the public data
    sets of implants that are described with x anterior have x posterior (the anterior flange lies at -x and flexion is
    a negative turn about z), and with it z to the left. Medial is what the caller says. A medial direction across
    another axis than z says that the frame is another one; only it and the axes are named then.

    Parameters
    ----------
    medial
        Unit vector towards medial in FIXED's frame; zero when it is not known.
    """
    x, y, z = (float(value) for value in medial)
    if x or y:
        named = {f"medial ({_axis(x, y, z)})": (x, y, z)}
        ways = [(s * float(k == 0), s * float(k == 1), s * float(k == 2)) for k in range(3) for s in (1, -1)]
        return named | {_axis(*way): way for way in ways if way != (x, y, z)}
    side = f"medial ({_axis(0.0, 0.0, z)})" if z else "−z"
    return {
        "+x": (1.0, 0.0, 0.0),
        side: (0.0, 0.0, z or -1.0),
        "superior (+y)": (0.0, 1.0, 0.0),
        "plantar (−y)": (0.0, -1.0, 0.0),
    }


def _axis(x: float, y: float, z: float) -> str:
    """+x, −z, … for a coordinate axis, the numbers for anything else."""
    for name, value in zip("xyz", (x, y, z), strict=True):
        if abs(value) == 1.0:
            return ("+" if value > 0.0 else "−") + name
    return f"{x:.2f}, {y:.2f}, {z:.2f}"

"""Phases of overhead work: rest, lift, screw-in, lower, from the elevation of an arm and the tool.

The arm is up from where its elevation first passes a share of its range to where it last does; within, the tool's first
and last use bound the screw-in, as the study of the exoskeleton marks them. Without a tool the arm counts as working
while it is within the uppermost part of its range.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

PHASES = ("rest", "lift", "screw-in", "lower")
"""By their numbers."""
RAISED, WORKING = 0.1, 0.9
"""Share of the range of elevation from which an arm is raised, and from which it works without a tool."""


def work_phases(
    elevation: Float[np.ndarray, " t"], tool: Bool[np.ndarray, " t"] | None = None
) -> Int[np.ndarray, " t"]:
    """Number of the phase in each frame.

    Parameters
    ----------
    elevation
        Of the human arm [rad].
    tool
        Whether the tool runs. ValueError where it never does while the arm is raised.
    """
    low, high = float(elevation.min()), float(elevation.max())
    up = np.flatnonzero(elevation > low + RAISED * (high - low))
    found = np.zeros(len(elevation), dtype=np.int64)
    if not len(up):
        return found
    first, last = int(up[0]), int(up[-1])
    used = elevation > low + WORKING * (high - low) if tool is None else tool
    inside = np.flatnonzero(used[first : last + 1]) + first
    if not len(inside):
        raise ValueError("the tool never runs while the arm is raised")
    found[first : inside[0]] = PHASES.index("lift")
    found[inside[0] : inside[-1] + 1] = PHASES.index("screw-in")
    found[inside[-1] + 1 : last + 1] = PHASES.index("lower")
    return found

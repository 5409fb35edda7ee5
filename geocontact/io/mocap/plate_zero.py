"""The offset of a force plate, from the frames in which its file says that nobody stands on it.

FORCE_PLATFORM:ZERO (c3d.org's user guide) names the first and the last of these frames, counted from 1; [0, 10] is
[1, 10], and [0, 0] names none. It is a default of many programs, so that somebody may stand on the plate in them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

LIGHT = 0.05
"""Share of the largest force beyond which a plate is loaded in the frames that are to tell its offset."""

STEADY = 0.01
"""Share of the largest force by which the force may scatter there (standard deviation)."""

EMPTY = 40.0, 20.0
"""Largest force, and range [N], of a plate that nobody stands on at any time: all of it may be offset."""

PART = 0.25
"""Share of the samples in these frames that must be unloaded."""

_NORMAL = 1.4826  # of a median deviation to a standard deviation
_WIDE = 4.0  # standard deviations that belong to the unloaded plate


@dataclass(frozen=True)
class Zero:
    """Which samples tell the offset, and what stands against it.

    Parameters
    ----------
    samples
        (t,) Those whose mean is the offset; None where nothing is taken off.
    doubt
        What has to be said; empty where nothing is odd or the file names no frames.
    """

    samples: Bool[np.ndarray, " t"] | None
    doubt: str = ""


def zero_samples(load: Float[np.ndarray, " t"], frames: Int[np.ndarray, " z"], per_frame: int) -> Zero:
    """Samples that tell the offset of a plate.

    Parameters
    ----------
    load
        Normal force [N], of either sign.
    frames
        FORCE_PLATFORM:ZERO; empty where the file has none.
    per_frame
        Samples of the plate per frame.
    """
    if len(frames) < 2 or not frames[:2].any():
        return Zero(None)
    first, last = max(int(frames[0]), 1), int(frames[1])
    named = f"FORCE_PLATFORM:ZERO names frames {int(frames[0])} to {last}"
    count = len(load) // per_frame
    if not first <= last or first > count:
        return Zero(None, f"{named} of {count}: no offset is taken off")
    within = np.zeros(len(load), bool)
    within[(first - 1) * per_frame : last * per_frame] = True
    light = within & _unloaded(load)
    inside = load[light]
    scatter = _NORMAL * float(np.median(np.abs(inside - np.median(inside)))) if len(inside) else 0.0
    largest = float(np.abs(load).max())
    if light.sum() < PART * within.sum() or scatter > STEADY * max(largest, EMPTY[0]):
        low, high = np.percentile(np.abs(load[within]), [5.0, 95.0])
        return Zero(None, f"{named}, in which it carries {low:.0f} to {high:.0f} N: no offset is taken off")
    quiet = light & (np.abs(load - np.median(inside)) <= max(_WIDE * scatter, 1e-3 * largest))
    if light.sum() == within.sum():
        return Zero(within)
    share = light.sum() / within.sum()
    return Zero(quiet, f"{named}, it is loaded in {1.0 - share:.0%} of them: its offset is that of the others")


def _unloaded(load: Float[np.ndarray, " t"]) -> Bool[np.ndarray, " t"]:
    largest, spread = float(np.abs(load).max()), float(np.ptp(load))
    if largest <= EMPTY[0] and spread <= EMPTY[1]:
        return np.ones(len(load), bool)
    return np.asarray(np.abs(load) <= LIGHT * largest)

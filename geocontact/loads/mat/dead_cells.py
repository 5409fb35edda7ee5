"""Cells of a mat that do not work, by what they read: the same in every frame while those around them are pressed.

Meant to raise no false alarm: of a recording with zeros at the rim of the contact, under an arch or between two thighs
nothing is taken for dead. So on a mat without noise a dead cell at a corner or at the rim of the contact, a broken row
and more than a few dead cells side by side are not found: a gap in the contact looks the same.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.pressure_frames import PressureFrames
from geocontact.loads.mat.load import TOUCHED

FEWEST_FRAMES = 10  # of a recording
MOST = 3  # cells side by side; more may be a gap in the contact
AROUND = 5  # working cells about them, at least: as many as a cell at the edge of a mat has
TOGETHER = 3  # frames in which all of those are pressed
PRESSED = 0.05  # of the largest rise of any cell
NEIGHBOURING = np.ones((3, 3), bool)  # a cell and the eight about it
FREE, RESTLESS = 20, 0.85  # cells that nothing presses, and the part of them that changes all the same
STUCK = 0.2  # of the largest rise; what a cell that is stuck high reads at least while nothing presses around it


def dead_cells(frames: PressureFrames, touched: float = TOUCHED) -> Bool[np.ndarray, "r c"]:
    """Cells that never change though they should: three ways to know them.

    All those around them are pressed; or they read much while none of those does; or all other cells of the mat show
    noise or drift even where nothing presses.

    Parameters
    ----------
    frames
        As they were read: offsets taken off and filters would make a stuck cell change.
    touched
        Rise above its lowest reading from which a cell counts as pressed, at least [Pa].
    """
    dead = np.zeros(frames.valid.shape, bool)
    if len(frames.time) < FEWEST_FRAMES:
        return dead
    from scipy.ndimage import binary_dilation, label

    pressure = np.where(frames.valid, frames.pressure, 0.0)
    rise = pressure - pressure.min(axis=0)
    largest = float(rise.max(initial=0.0))
    high = pressure[0] >= max(touched, STUCK * largest)
    still = frames.valid & (rise.max(axis=0) == 0.0)
    level = max(touched, PRESSED * largest)
    if _restless(pressure, frames.valid, level):
        dead |= still
    for alike in (still & (pressure[0] == 0.0), still & (pressure[0] != 0.0)):
        groups, count = label(alike, NEIGHBOURING)
        for k in range(1, count + 1):
            group = groups == k
            around = binary_dilation(group, NEIGHBOURING) & frames.valid & ~group
            if group.sum() > MOST or around.sum() < AROUND:
                continue
            pressed = (rise[:, around] >= level).all(axis=1)
            quiet = (pressure[:, around] < touched).all(axis=1)
            if pressed.sum() >= TOGETHER:
                dead |= group & _flanked(group, around)
            elif quiet.any() and largest > 0.0:
                dead |= group & high
    return dead


def _restless(pressure: Float[np.ndarray, "t r c"], valid: Bool[np.ndarray, "r c"], level: float) -> bool:
    """Whether even cells that nothing presses change on this mat, by noise or drift: then none that works stands still.

    Looked at in the third of the frames with the smallest force, in the cells that change by less than `level` [Pa].
    """
    order = np.argsort(pressure.sum(axis=(1, 2)), kind="stable")
    change = np.ptp(pressure[order[: len(order) // 3]], axis=0)
    free = valid & (change < level)
    return bool(free.sum() >= FREE and (change[free] > 0.0).mean() >= RESTLESS)


def _flanked(group: Bool[np.ndarray, "r c"], around: Bool[np.ndarray, "r c"]) -> bool:
    """Whether each cell of a group has cells of its surroundings on two opposite sides, along its row or column.

    Those that a round contact leaves out at a corner of the mat have not.
    """
    return all(
        any(_reached(group, around, at, step) and _reached(group, around, at, -step) for step in np.eye(2, dtype=int))
        for at in np.argwhere(group)
    )


def _reached(
    group: Bool[np.ndarray, "r c"],
    around: Bool[np.ndarray, "r c"],
    at: Int[np.ndarray, " 2"],
    step: Int[np.ndarray, " 2"],
) -> bool:
    """Whether a walk out of a group ends in its surroundings."""
    while (at >= 0).all() and (at < group.shape).all() and group[tuple(at)]:
        at = at + step
    return bool((at >= 0).all() and (at < group.shape).all() and around[tuple(at)])

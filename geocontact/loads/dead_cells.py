"""Cells of a mat that do not work: recognised by what they read, and filled from those around them.

Meant to raise no false alarm: of a recording with zeros at the rim of the contact, under an arch or between two thighs
nothing is taken for dead. So on a mat without noise a dead cell at a corner or at the rim of the contact, a broken row
and more than a few dead cells side by side are not found: a gap in the contact looks the same.

The pressure in a hole is harmonic: every filled cell is the mean of its four neighbours, weighted with 1 / pitch^2, and
neighbours that are not there do not pull (five-point Laplacian, no flux across the rim of the mat). So it lies between
what the cells around the hole read, and a pressure that is linear over the mat is met exactly where the hole has
neighbours on all sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.frame_blocks import parts, worked
from geocontact.data.pressure_frames import PressureFrames
from geocontact.data.wrench import Wrench
from geocontact.loads.mat_load import COVARIANCE, TOUCHED
from geocontact.loads.mat_map import MatMap

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

    pressure = frames.pressure
    if not frames.valid.all():
        pressure = worked(lambda part: np.where(frames.valid, part, 0.0), pressure)
    lowest, highest = _ends(pressure)
    rise = highest - lowest
    largest = float(rise.max(initial=0.0))
    high = pressure[0] >= max(touched, STUCK * largest)
    still = frames.valid & (rise == 0.0)
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
            pressed, quiet = 0, False
            for (part,) in parts(pressure):
                pressed += int((part[:, around] - lowest[around] >= level).all(axis=1).sum())
                quiet = quiet or bool((part[:, around] < touched).all(axis=1).any())
            if pressed >= TOGETHER:
                dead |= group & _flanked(group, around)
            elif quiet and largest > 0.0:
                dead |= group & high
    return dead


def _ends(
    pressure: Float[np.ndarray, "t r c"], chosen: Bool[np.ndarray, " t"] | None = None
) -> tuple[Float[np.ndarray, "r c"], Float[np.ndarray, "r c"]]:
    """Lowest and highest reading of each cell, in the chosen frames; endless where none is."""
    counted = np.ones(len(pressure), bool) if chosen is None else chosen
    each = [
        (part[some].min(axis=0, initial=np.inf), part[some].max(axis=0, initial=-np.inf))
        for part, some in parts(pressure, counted)
    ]
    return np.min([low for low, _ in each], axis=0), np.max([high for _, high in each], axis=0)


def _restless(pressure: Float[np.ndarray, "t r c"], valid: Bool[np.ndarray, "r c"], level: float) -> bool:
    """Whether even cells that nothing presses change on this mat, by noise or drift: then none that works stands still.

    Looked at in the third of the frames with the smallest force, in the cells that change by less than `level` [Pa].
    """
    order = np.argsort(worked(lambda part: part.sum(axis=(1, 2)), pressure), kind="stable")
    quiet = np.zeros(len(pressure), bool)
    quiet[order[: len(order) // 3]] = True
    lowest, highest = _ends(pressure, quiet)
    change = highest - lowest
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


SIDES = ((-1, 0), (1, 0), (0, -1), (0, 1))
UNKNOWN = 1.0  # the share that a filling is off by where the recording cannot tell


@dataclass(frozen=True, eq=False)
class Hole:
    """Dead cells side by side, and how they are filled.

    Parameters
    ----------
    cell
        Row and column of each.
    source
        Row and column of the working cells about them.
    weight
        Of each source in each cell; rows sum to 1.
    share
        How far a filling is off, of what it says: holes of the same shape made in the working cells of the recording,
        root mean square of (filled - read) over root mean square of filled, over all places and frames. What is off
        grows and shrinks with the load, so that a share tells it better than a pressure.
    """

    cell: Int[np.ndarray, "k 2"]
    source: Int[np.ndarray, "s 2"]
    weight: Float[np.ndarray, "k s"]
    share: float = UNKNOWN

    def of(self, pressure: Float[np.ndarray, "t r c"]) -> Float[np.ndarray, "t k"]:
        """What they would have read [Pa]."""
        return np.asarray(pressure[:, self.source[:, 0], self.source[:, 1]] @ self.weight.T)


def holes(
    pressure: Float[np.ndarray, "t r c"],
    works: Bool[np.ndarray, "r c"],
    dead: Bool[np.ndarray, "r c"],
    pitch: tuple[float, float],
) -> tuple[Hole, ...]:
    """Each group of dead cells that has a working cell beside it; groups without one are left out."""
    from scipy.ndimage import label

    works = works & ~dead
    groups, count = label(dead)
    found = (_hole(np.argwhere(groups == k), works, pitch) for k in range(1, count + 1))
    return tuple(
        Hole(one.cell, one.source, one.weight, _share(one.cell, pressure, works, pitch)) for one in found if one
    )


def filled(pressure: Float[np.ndarray, "t r c"], gaps: tuple[Hole, ...]) -> Float[np.ndarray, "t r c"]:
    """Pressures [Pa] with the holes filled."""

    def of_part(part: Float[np.ndarray, "t r c"]) -> Float[np.ndarray, "t r c"]:
        whole = part.copy()
        for hole in gaps:
            whole[:, hole.cell[:, 0], hole.cell[:, 1]] = hole.of(part)
        return whole

    return worked(of_part, pressure)


def filling_covariance(
    placed: MatMap, pressure: Float[np.ndarray, "t n"], wrench: Wrench, gaps: tuple[Hole, ...]
) -> Float[np.ndarray, "t six six"]:
    """What filling adds to the covariance of force [N] and moment [N m] about the wrench's origin, frame by frame.

    Cells of one hole are off together, by the hole's share of what they are filled with; holes are independent.
    """
    own = np.concatenate([placed.force, placed.moment - np.cross(wrench.origin[0], placed.force)], axis=1)
    inside = [(placed.cell[:, None] == hole.cell[None]).all(axis=2).any(axis=1) for hole in gaps]

    def of_part(part: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t six six"]:
        total = np.zeros((len(part), 6, 6))
        for hole, cells in zip(gaps, inside, strict=True):
            off = hole.share * (part[:, cells] @ own[cells])
            total += off[:, :, None] * off[:, None, :]
        return total

    return worked(of_part, pressure, each=COVARIANCE)


def _hole(cell: Int[np.ndarray, "k 2"], works: Bool[np.ndarray, "r c"], pitch: tuple[float, float]) -> Hole | None:
    """The harmonic filling of a group of cells; None where no working cell is beside it."""
    place = {(int(r), int(c)): k for k, (r, c) in enumerate(cell)}
    pull = np.zeros((len(cell), len(cell)))
    source: dict[tuple[int, int], int] = {}
    entries: list[tuple[int, int, float]] = []
    for (r, c), k in place.items():
        for down, aside in SIDES:
            there = r + down, c + aside
            if not (0 <= there[0] < works.shape[0] and 0 <= there[1] < works.shape[1]):
                continue
            weight = float(np.square(min(pitch) / pitch[0 if down else 1]))
            if there in place:
                pull[k, place[there]] -= weight
            elif works[there]:
                entries.append((k, source.setdefault(there, len(source)), weight))
            else:
                continue
            pull[k, k] += weight
    if not source:
        return None
    known = np.zeros((len(cell), len(source)))
    for k, s, weight in entries:
        known[k, s] = weight
    return Hole(cell, np.array(list(source)), np.linalg.solve(pull, known))


def _share(
    cell: Int[np.ndarray, "k 2"],
    pressure: Float[np.ndarray, "t r c"],
    works: Bool[np.ndarray, "r c"],
    pitch: tuple[float, float],
) -> float:
    """How far off the filling of holes of this shape is, made where the mat works."""
    shape = cell - cell.min(axis=0)
    off = told = 0.0
    for at in np.argwhere(np.ones(works.shape, bool)):
        there = shape + at
        if (there >= works.shape).any() or not works[there[:, 0], there[:, 1]].all():
            continue
        rest = works.copy()
        rest[there[:, 0], there[:, 1]] = False
        hole = _hole(there, rest, pitch)
        if hole is None:
            continue
        for (part,) in parts(pressure):
            guess = hole.of(part)
            off += float(np.square(guess - part[:, there[:, 0], there[:, 1]]).sum())
            told += float(np.square(guess).sum())
    return float(np.sqrt(off / told)) if told > 0.0 else UNKNOWN

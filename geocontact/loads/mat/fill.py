"""Cells that do not work, filled from those around them, and how far off such a filling is.

The pressure in a hole is harmonic: every filled cell is the mean of its four neighbours, weighted with 1 / pitch^2, and
neighbours that are not there do not pull (five-point Laplacian, no flux across the rim of the mat). So it lies between
what the cells around the hole read, and a pressure that is linear over the mat is met exactly where the hole has
neighbours on all sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.wrench import Wrench
from geocontact.loads.mat.map import MatMap

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
    whole = pressure.copy()
    for hole in gaps:
        whole[:, hole.cell[:, 0], hole.cell[:, 1]] = hole.of(pressure)
    return whole


def filling_covariance(
    placed: MatMap, pressure: Float[np.ndarray, "t n"], wrench: Wrench, gaps: tuple[Hole, ...]
) -> Float[np.ndarray, "t six six"]:
    """What filling adds to the covariance of force [N] and moment [N m] about the wrench's origin, frame by frame.

    Cells of one hole are off together, by the hole's share of what they are filled with; holes are independent.
    """
    own = np.concatenate([placed.force, placed.moment - np.cross(wrench.origin[0], placed.force)], axis=1)
    total = np.zeros((len(pressure), 6, 6))
    for hole in gaps:
        inside = (placed.cell[:, None] == hole.cell[None]).all(axis=2).any(axis=1)
        off = hole.share * (pressure[:, inside] @ own[inside])
        total += off[:, :, None] * off[:, None, :]
    return total


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
        guess = hole.of(pressure)
        off += float(np.square(guess - pressure[:, there[:, 0], there[:, 1]]).sum())
        told += float(np.square(guess).sum())
    return float(np.sqrt(off / told)) if told > 0.0 else UNKNOWN

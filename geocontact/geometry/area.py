"""Area of a surface within a threshold of another one, with certified bounds.

The area of {x on A : sd(x) <= T} is what the two triangulated surfaces define; sd is the signed distance to B where B is
closed, the plain distance where it is open. Faces that the certificates of `kernels.certify` decide are counted whole.
The others are cut along the linear interpolation of sd between their corners (second order in the edge length) and
divided into four as long as the cut still moves, or the bounds are wider than asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float, Int, Int8

from geocontact.geometry.kernels.certify import certify
from geocontact.geometry.kernels.clip import clipped_parts
from geocontact.geometry.kernels.faces import quarter, sort_faces
from geocontact.geometry.sampled import QUARTERS, Distances, Sampled, measure
from geocontact.geometry.surface import Surface

SMALLEST = 1e-10  # m^2; an upper bound below this is not refined further


@dataclass(frozen=True)
class Refinement:
    """When to stop dividing triangles.

    accuracy
        Estimated error of the area relative to the area itself.
    single
        Largest undecided share of the upper bound that one triangle may keep.
    bounds
        Largest (upper - lower) / upper; None leaves the bounds as the accuracy makes them.
    depth
        Largest number of divisions; 0 cuts the given triangles as they are.
    """

    accuracy: float = 5e-4
    single: float = 0.01
    bounds: float | None = None
    depth: int = 16


AS_GIVEN = Refinement(depth=0)


@dataclass(frozen=True)
class AreaWithin:
    """Area within the threshold [m^2], its certified bounds and estimated error, first moment and one-sided part.

    moment
        Integral of position over the area [m^3], in the measured surface's frame.
    negative
        Part on the negative side of the splitting plane [m^2].
    """

    area: float
    lower: float
    upper: float
    error: float
    moment: Float[np.ndarray, " 3"]
    negative: float
    undecided: int = 0

    @property
    def centroid(self) -> Float[np.ndarray, " 3"]:
        """Area centroid of the patch [m]; NaN when the area is zero."""
        if self.area <= 0.0:
            return np.full(3, np.nan)
        return np.asarray(self.moment / self.area)


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Triangles still under examination; positions about the other surface's centre."""

    corner: Float[np.ndarray, "k 3 3"]
    closest: Float[np.ndarray, "k 3 3"]
    distance: Float[np.ndarray, "k 3"]
    side: Int8[np.ndarray, "k 3"]
    slot: Int[np.ndarray, "k 3"]
    across: Float[np.ndarray, "k 3"]
    area: Float[np.ndarray, " k"]
    lower: Float[np.ndarray, " k"]
    upper: Float[np.ndarray, " k"]
    part: Float[np.ndarray, " k"]
    moment: Float[np.ndarray, "k 3"]
    negative: Float[np.ndarray, " k"]
    error: Float[np.ndarray, " k"]

    def __getitem__(self, chosen: np.ndarray) -> _Pieces:
        return _Pieces(*(getattr(self, f.name)[chosen] for f in fields(self)))

    def __add__(self, other: _Pieces) -> _Pieces:
        return _Pieces(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(self)))


def area_within(
    sampled: Sampled,
    other: Surface,
    distances: Distances,
    threshold: float,
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    refinement: Refinement = Refinement(),
) -> AreaWithin:
    """Area of `sampled` whose signed distance to `other` is <= threshold [m], at the pose of `distances`."""
    d = distances
    signed = other.closed
    totals, undecided = sort_faces(
        sampled.faces, d.points, d.distance, d.side, d.slot, d.closest, threshold, signed,
        sampled.area, sampled.moment, sampled.negative,
    )  # fmt: skip
    whole = float(totals[0])
    pieces = _first_pieces(sampled, d, undecided, threshold, signed)
    if refinement.depth > 0:
        pieces = _refine(pieces, other, threshold, refinement, whole)
    part = float(pieces.part.sum())
    lower = whole + float(pieces.lower @ pieces.area)
    upper = whole + float(pieces.upper @ pieces.area)
    shift = rotation @ sampled.surface.centre + translation - other.centre
    moment = totals[1:4] + (pieces.moment.sum(axis=0) - part * shift) @ rotation
    area = whole + part
    return AreaWithin(
        area=min(max(area, lower), upper),
        lower=lower,
        upper=upper,
        error=float(pieces.error.sum()),
        moment=moment + area * sampled.surface.centre,
        negative=float(totals[4]) + float(pieces.negative.sum()),
        undecided=d.undecided,
    )


def _first_pieces(
    sampled: Sampled, d: Distances, undecided: Int[np.ndarray, " k"], threshold: float, signed: bool
) -> _Pieces:
    f = sampled.faces[undecided]
    return _examined(
        d.points[f], d.closest[f], d.distance[f], d.side[f], d.slot[f], sampled.across[f], sampled.area[undecided],
        threshold, signed,
    )  # fmt: skip


def _examined(
    corner: Float[np.ndarray, "k 3 3"],
    closest: Float[np.ndarray, "k 3 3"],
    distance: Float[np.ndarray, "k 3"],
    side: Int8[np.ndarray, "k 3"],
    slot: Int[np.ndarray, "k 3"],
    across: Float[np.ndarray, "k 3"],
    area: Float[np.ndarray, " k"],
    threshold: float,
    signed: bool,
) -> _Pieces:
    """Pieces with their bounds and their linear cut; the error of a piece never divided is taken as its whole doubt."""
    lower, upper = certify(corner, closest, distance, side, slot, threshold, signed)
    part, moment, negative = clipped_parts(corner, side * distance - threshold, across, area)
    return _Pieces(
        corner, closest, distance, side, slot, across, area, lower, upper, part, moment, negative,
        (upper - lower) * area,
    )  # fmt: skip


def _refine(pieces: _Pieces, other: Surface, threshold: float, rule: Refinement, whole: float) -> _Pieces:
    settled: list[_Pieces] = []
    for level in range(rule.depth):
        done = settled + [pieces]
        upper = whole + sum(float(p.upper @ p.area) for p in done)
        area = whole + sum(float(p.part.sum()) for p in done)
        gap = (pieces.upper - pieces.lower) * pieces.area
        if upper < SMALLEST or len(pieces.area) == 0:
            break
        wanted = np.full(len(gap), level == 0) | (gap > rule.single * upper)
        if sum(float(p.error.sum()) for p in done) > rule.accuracy * area:
            wanted |= pieces.error > 0.25 * rule.accuracy * area / len(pieces.error)
        total_gap = sum(float(((p.upper - p.lower) * p.area).sum()) for p in done)
        if rule.bounds is not None and total_gap > rule.bounds * upper:
            wanted |= gap > 0.25 * rule.bounds * upper / len(gap)
        wanted &= gap > 0.0
        if not wanted.any():
            break
        settled.append(pieces[~wanted])
        pieces = _divided(pieces[wanted], other, threshold)
    for part in settled:
        pieces = pieces + part
    return pieces


def _divided(parent: _Pieces, other: Surface, threshold: float) -> _Pieces:
    """Each piece replaced by its four quarters, with distances asked for at the new corners."""
    k = len(parent.area)
    middle = quarter(parent.corner)
    edge = np.linalg.norm(np.roll(parent.corner, -1, axis=1) - np.roll(parent.corner, 1, axis=1), axis=2)
    limit = np.repeat(threshold + edge.max(axis=1), 3)
    new = measure(other, middle.reshape(-1, 3), limit)

    def both(old: np.ndarray, added: np.ndarray) -> np.ndarray:
        joined = np.concatenate([old, added.reshape(old.shape)], axis=1)  # corners 0 1 2, middles 3 4 5
        return np.asarray(joined[:, QUARTERS].reshape(4 * k, 3, *old.shape[2:]))

    across = 0.5 * (np.roll(parent.across, -1, axis=1) + np.roll(parent.across, 1, axis=1))
    child = _examined(
        both(parent.corner, middle), both(parent.closest, new.closest), both(parent.distance, new.distance),
        both(parent.side, new.side), both(parent.slot, new.slot), both(parent.across, across),
        np.repeat(0.25 * parent.area, 4), threshold, other.closed,
    )  # fmt: skip
    change = np.abs(child.part.reshape(k, 4).sum(axis=1) - parent.part) / 3.0  # second order: a quarter remains
    error = np.minimum(np.repeat(0.25 * change, 4), (child.upper - child.lower) * child.area)
    return _Pieces(*(error if f.name == "error" else getattr(child, f.name) for f in fields(child)))

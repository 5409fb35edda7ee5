"""Area of a surface within a threshold of another one, with certified bounds.

The area of {x on A : sd(x) <= T} is what the two triangulated surfaces define; sd is the signed distance to B where B is
closed, the plain distance where it is open. Faces that the certificates of `kernels.certify` decide are counted whole.
The others are cut along the linear interpolation of sd between their corners (second order in the edge length) and
divided into four as long as the cut still moves, or the bounds are wider than asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.kernels.certify import certify
from geocontact.geometry.kernels.clip import clipped_parts
from geocontact.geometry.sampled import Distances, Sampled
from geocontact.geometry.subdivision import compact, quartered
from geocontact.geometry.surface import Surface

PIECES = 100_000  # at most this many triangles are divided at a time, the most doubtful first
STALLED = 0.9  # a division that leaves more of the doubt than this will not end: surfaces exactly a threshold apart
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
    """Triangles under examination: corners in a set of measured points, area, certified shares and linear cut."""

    faces: Int[np.ndarray, "k 3"]
    area: Float[np.ndarray, " k"]
    lower: Float[np.ndarray, " k"]
    upper: Float[np.ndarray, " k"]
    part: Float[np.ndarray, " k"]
    moment: Float[np.ndarray, "k 3"]
    negative: Float[np.ndarray, " k"]
    error: Float[np.ndarray, " k"]

    def __getitem__(self, chosen: np.ndarray) -> _Pieces:
        return _Pieces(*(getattr(self, f.name)[chosen] for f in fields(self)))

    @property
    def gap(self) -> Float[np.ndarray, " k"]:
        """Area that is neither certainly within nor certainly outside [m^2]."""
        return (self.upper - self.lower) * self.area


@dataclass
class _Sums:
    """Running totals of what is settled; moment about the other surface's centre."""

    area: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    error: float = 0.0
    gap: float = 0.0
    negative: float = 0.0
    moment: Float[np.ndarray, " 3"] = field(default_factory=lambda: np.zeros(3))

    def with_(self, pieces: _Pieces) -> _Sums:
        return _Sums(
            self.area + float(pieces.part.sum()),
            self.lower + float(pieces.lower @ pieces.area),
            self.upper + float(pieces.upper @ pieces.area),
            self.error + float(pieces.error.sum()),
            self.gap + float(pieces.gap.sum()),
            self.negative + float(pieces.negative.sum()),
            self.moment + pieces.moment.sum(axis=0),
        )


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
    lower, upper = certify(
        sampled.faces, d.points, d.distance, d.side, d.slot, d.closest, threshold, other.closed
    )
    sure = lower >= 1.0
    moment = sampled.moment[sure].sum(axis=0)
    sums = _Sums(*[float(sampled.area[sure].sum())] * 3, negative=float(sampled.negative[sure].sum()))
    doubtful = np.flatnonzero(~sure & (upper > 0.0))
    faces, points = compact(sampled.faces[doubtful], d)
    pieces = _examined(faces, points, sampled.area[doubtful], threshold, other.closed)
    sums = _refined(sums, pieces, points, other, threshold, refinement)
    # the pieces' moment is about the other's centre and in its axes
    shift = rotation @ sampled.surface.centre + translation - other.centre
    moment += (sums.moment - (sums.area - float(sampled.area[sure].sum())) * shift) @ rotation
    return AreaWithin(
        area=min(max(sums.area, sums.lower), sums.upper),
        lower=sums.lower,
        upper=sums.upper,
        error=sums.error,
        moment=moment + sums.area * sampled.surface.centre,
        negative=sums.negative,
        undecided=d.undecided,
    )


def _examined(
    faces: Int[np.ndarray, "k 3"], points: Distances, area: Float[np.ndarray, " k"], threshold: float, signed: bool
) -> _Pieces:
    """Pieces with their bounds and their linear cut; the error of a piece never divided is taken as its whole doubt."""
    p = points
    lower, upper = certify(faces, p.points, p.distance, p.side, p.slot, p.closest, threshold, signed)
    part, moment, negative = clipped_parts(faces, p.points, p.side * p.distance - threshold, p.across, area)
    return _Pieces(faces, area, lower, upper, part, moment, negative, (upper - lower) * area)


def _refined(
    settled: _Sums, pieces: _Pieces, points: Distances, other: Surface, threshold: float, rule: Refinement
) -> _Sums:
    """Divide the pieces as long as `rule` asks for it and return the totals."""
    before = np.inf
    for level in range(rule.depth):
        now = settled.with_(pieces)
        wanted = _wanted(now, pieces, rule, first=level == 0)
        if not wanted.any() or now.gap > STALLED * before:
            break
        before = now.gap
        settled = settled.with_(pieces[~wanted])
        faces, points = compact(pieces.faces[wanted], points)
        faces, points = quartered(faces, points, other, threshold)
        child = _examined(faces, points, np.repeat(0.25 * pieces.area[wanted], 4), threshold, other.closed)
        change = np.abs(child.part.reshape(-1, 4).sum(axis=1) - pieces.part[wanted]) / 3.0  # order 2: a quarter is left
        pieces = replace(child, error=np.minimum(np.repeat(0.25 * change, 4), child.gap))
    return settled.with_(pieces)


def _wanted(now: _Sums, pieces: _Pieces, rule: Refinement, first: bool) -> Bool[np.ndarray, " k"]:
    """Which pieces to divide: all once, then those that hold more than their share of what is too much."""
    if now.upper < SMALLEST or len(pieces.area) == 0:
        return np.zeros(len(pieces.area), bool)
    gap = pieces.gap
    wanted = np.full(len(gap), first) | (gap > rule.single * now.upper)
    if now.error > rule.accuracy * now.area:
        wanted |= pieces.error > 0.25 * rule.accuracy * now.area / len(gap)
    if rule.bounds is not None and now.gap > rule.bounds * now.upper:
        wanted |= gap > 0.25 * rule.bounds * now.upper / len(gap)
    wanted &= gap > 0.0
    if np.count_nonzero(wanted) > PIECES:
        wanted &= gap >= np.sort(gap[wanted])[-PIECES]
    return np.asarray(wanted)

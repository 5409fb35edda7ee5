"""Area of a surface within a threshold of another one, with certified bounds.

The area of {x on A : sd(x) <= T} is what the two triangulated surfaces define; sd is the signed distance to B where B
is closed, the plain distance where it is open. Faces that the certificates of `kernels.certify` decide count whole.
The others are cut along the linear interpolation of sd between their corners (second order in the edge length) and
divided into four as long as the cut still moves, or the bounds are wider than asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.contact_area.sampled import Distances, Sampled, compact, measure, quartered
from geocontact.geometry.kernels.certify import certify, totals
from geocontact.geometry.kernels.clip import areas_below, clipped_parts
from geocontact.geometry.surface import Surface

REFINED = "refined"  # cut along the iso-line, triangles divided until the area has settled
CLIP = "clip"  # cut along the iso-line on the triangles as given: second order
ALL_VERTICES = "all-vertices"  # whole faces, all three corners within: first order, low
ANY_VERTEX = "any-vertex"  # whole faces, any corner within: first order, high
CENTROID = "centroid"  # whole faces, centroid within: erratic
RULES = (REFINED, CLIP, ALL_VERTICES, ANY_VERTEX, CENTROID)


def counted_area(
    sampled: Sampled, other: Surface, distances: Distances, threshold: float, rule: str
) -> tuple[float, np.ndarray, float]:
    """Area [m^2] of the whole faces that a crude rule counts, its first moment (about the surface's own centre) [m^3]
    and the part on the negative side of the splitting plane [m^2].
    """
    inside = _counts(sampled, other, distances, threshold, rule)
    return (
        float(sampled.area[inside].sum()),
        sampled.moment[inside].sum(axis=0),
        float(sampled.negative[inside].sum()),
    )


def _counts(sampled: Sampled, other: Surface, d: Distances, threshold: float, rule: str) -> np.ndarray:
    if rule == CENTROID:
        middle = d.points[sampled.faces].mean(axis=1)
        return measure(other, middle, np.full(len(middle), 2.0 * threshold + 1e-12)).signed <= threshold
    corners = (d.signed <= threshold)[sampled.faces]
    if rule == ALL_VERTICES:
        return np.asarray(corners.all(axis=1))
    if rule == ANY_VERTEX:
        return np.asarray(corners.any(axis=1))
    raise ValueError(f"rule must be one of {', '.join(RULES)}, not {rule!r}")


BLIND = 0.01  # share of the doubt that counts as error where the cut cannot show any
STALLED = 0.9  # three divisions that leave more of the doubt than this: the surfaces are exactly a threshold apart
SAME = 1e-9  # doubts of symmetric pieces differ by rounding, which follows the order of their corners
SMALLEST = 1e-10  # m^2; an upper bound below this is not refined further


@dataclass(frozen=True)
class Refinement:
    """When to stop dividing triangles.

    Parameters
    ----------
    accuracy
        Estimated error of the area relative to the area itself.
    bounds
        Largest (upper - lower) / upper. Where all corners of a triangle lie on one side of the threshold the estimated
        error does not see an iso-line that bulges into it; the bounds do.
    depth
        Largest number of divisions; 0 cuts the given triangles as they are.
    pieces
        Largest number of triangles divided in all, the most doubtful first (equally doubtful ones together): a bound on
        the time where thresholds are small against the triangles. What is left undecided shows in the bounds.

    Examples
    --------
    >>> import geocontact as gc
    >>> gc.Refinement(accuracy=1e-3).accuracy
    0.001
    """

    accuracy: float = 2e-4
    bounds: float = 0.1
    depth: int = 16
    pieces: int = 200_000


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
    """Triangles under examination: corners in a set of measured points, edges, area, certified shares, linear cut."""

    faces: Int[np.ndarray, "k 3"]
    edges: Float[np.ndarray, "k 3"]
    area: Float[np.ndarray, " k"]
    lower: Float[np.ndarray, " k"]
    upper: Float[np.ndarray, " k"]
    part: Float[np.ndarray, " k"]
    moment: Float[np.ndarray, "k 3"]
    negative: Float[np.ndarray, " k"]
    error: Float[np.ndarray, " k"]

    def __getitem__(self, chosen: np.ndarray) -> _Pieces:
        at = np.flatnonzero(chosen)
        return _Pieces(*(values.take(at, axis=0) for values in vars(self).values()))

    @property
    def gap(self) -> Float[np.ndarray, " k"]:
        """Area that is neither certainly within nor certainly outside [m^2]."""
        return np.asarray((self.upper - self.lower) * self.area)


@dataclass
class _AreaSums:
    """Running totals of what is settled; moment about the other surface's centre."""

    area: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    error: float = 0.0
    gap: float = 0.0
    negative: float = 0.0
    moment: Float[np.ndarray, " 3"] = field(default_factory=lambda: np.zeros(3))

    def with_(self, pieces: _Pieces) -> _AreaSums:
        return _AreaSums(
            self.area + float(pieces.part.sum()),
            self.lower + float(pieces.lower @ pieces.area),
            self.upper + float(pieces.upper @ pieces.area),
            self.error + float(pieces.error.sum()),
            self.gap + float((pieces.upper - pieces.lower) @ pieces.area),
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
        sampled.faces, d.points, d.distance, d.side, d.slot, d.closest, sampled.edges, threshold, other.closed
    )
    whole, doubtful = totals(lower, upper, sampled.area, sampled.moment, sampled.negative)
    faces, points = compact(sampled.faces[doubtful], d)
    edges, areas = sampled.edges[doubtful], sampled.area[doubtful]
    start = _AreaSums(whole[0], whole[0], whole[0], negative=whole[4])
    pieces = _cut(faces, points, edges, areas, lower[doubtful], upper[doubtful], threshold)
    sums = _refined(start, pieces, points, other, threshold, refinement)
    # the pieces' moment is about the other's centre and in its axes
    shift = rotation @ sampled.surface.centre + translation - other.centre
    moment = whole[1:4] + (sums.moment - (sums.area - whole[0]) * shift) @ rotation
    area = min(max(sums.area, sums.lower), sums.upper)
    scale = area / sums.area if sums.area > 0.0 else 1.0  # the estimate is kept within its bounds, parts and all
    moment = scale * (moment + sums.area * sampled.surface.centre)
    return AreaWithin(
        area=area,
        lower=sums.lower,
        upper=sums.upper,
        error=sums.error,
        moment=moment,
        negative=scale * sums.negative,
        undecided=d.undecided,
    )


def areas_cut_once(sampled: Sampled, distances: Distances, thresholds: tuple[float, ...]) -> Float[np.ndarray, " s"]:
    """Areas [m^2] of triangles cut as given, each as `area_within` with `AS_GIVEN` finds it, at many thresholds [m].

    No certificates are needed for that: signed distances of corners differ by no more than the edge between them, so
    the cut of a triangle never leaves its certified bounds, and corners beyond their limit decide it at any threshold.
    """
    if not thresholds:
        return np.zeros(0)
    order = np.argsort(thresholds)
    found = np.empty(len(order))
    signed = distances.side * distances.distance
    found[order] = areas_below(sampled.faces, signed, sampled.area, np.asarray(thresholds, float)[order])
    return found


def _cut(
    faces: Int[np.ndarray, "k 3"],
    points: Distances,
    edges: Float[np.ndarray, "k 3"],
    area: Float[np.ndarray, " k"],
    lower: Float[np.ndarray, " k"],
    upper: Float[np.ndarray, " k"],
    threshold: float,
) -> _Pieces:
    """Pieces with their linear cut; the error of a piece never divided is taken as its whole doubt."""
    signed = points.side * points.distance - threshold
    part, moment, negative = clipped_parts(faces, points.points, signed, points.across, area)
    return _Pieces(faces, edges, area, lower, upper, part, moment, negative, (upper - lower) * area)


def _refined(
    settled: _AreaSums, pieces: _Pieces, points: Distances, other: Surface, threshold: float, rule: Refinement
) -> _AreaSums:
    """Divide the pieces as long as `rule` asks for it and return the totals."""
    gaps: list[float] = []
    left = rule.pieces
    for level in range(rule.depth):
        now = settled.with_(pieces)
        stalled = level > 3 and now.gap > STALLED * gaps[-3]
        gaps.append(now.gap)
        wanted = _wanted(now, pieces, rule, first=level == 0)
        if stalled or left <= 0 or not wanted.any():
            break
        wanted = _most(wanted, pieces.gap, left)
        left -= int(np.count_nonzero(wanted))
        settled = settled.with_(pieces[~wanted])
        faces, points = compact(pieces.faces[wanted], points)
        faces, points = quartered(faces, points, other, threshold)
        # the quarters are similar to their parent, so their edges are half of its edges
        edges, area = np.repeat(0.5 * pieces.edges[wanted], 4, axis=0), np.repeat(0.25 * pieces.area[wanted], 4)
        p = points
        lower, upper = certify(faces, p.points, p.distance, p.side, p.slot, p.closest, edges, threshold, other.closed)
        child = _cut(faces, points, edges, area, lower, upper, threshold)
        pieces = replace(child, error=_error(pieces.part[wanted], child))
    return settled.with_(pieces)


def _error(parent: Float[np.ndarray, " p"], child: _Pieces) -> Float[np.ndarray, " k"]:
    """Estimated error of the linear cut in each quarter [m^2], given the cuts of the parents.

    A second-order cut that moved by x when the edges were halved is off by x / 3. A cut that leaves a quarter whole or
    empty does not move when an iso-line bulges into it: there a share of what is not certain counts.
    """
    moved = np.abs(child.part.reshape(-1, 4).sum(axis=1) - parent) / 3.0
    blind = (child.part <= 0.0) | (child.part >= child.area)
    return np.asarray(np.where(blind, BLIND * child.gap, np.minimum(np.repeat(0.25 * moved, 4), child.gap)))


def _wanted(now: _AreaSums, pieces: _Pieces, rule: Refinement, first: bool) -> Bool[np.ndarray, " k"]:
    """Which pieces to divide: all once, then those that hold more than their share of what is too much."""
    if now.upper < SMALLEST or len(pieces.area) == 0:
        return np.zeros(len(pieces.area), bool)
    gap = pieces.gap
    wanted = np.full(len(gap), first)
    if now.error > rule.accuracy * now.area:
        wanted |= pieces.error > 0.25 * rule.accuracy * now.area / len(gap)
    if now.gap > rule.bounds * now.upper:
        wanted |= gap > 0.25 * rule.bounds * now.upper / len(gap)
    wanted &= gap > 0.0
    return np.asarray(wanted)


def _most(wanted: Bool[np.ndarray, " k"], gap: Float[np.ndarray, " k"], count: int) -> Bool[np.ndarray, " k"]:
    """The `count` wanted pieces with the largest gap, and those that equal the last of them but for rounding."""
    if np.count_nonzero(wanted) <= count:
        return wanted
    last = -np.partition(-gap[wanted], count - 1)[count - 1]
    return np.asarray(wanted & (gap >= last * (1.0 - SAME)))

"""Where a mat lies, from marks on it that were found on the body."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from geocontact.geometry.drape.geodesics import Geodesics, SurfacePoints
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Anchor, Way, spread

Missed = Callable[[Anchor], Float[np.ndarray, " n"]]

STEP = 1e-4  # m and rad, of the central differences
SETTLED = 1e-7  # m and rad
ROUNDS = 30
HALVINGS = 6
GAIN = 1e-6  # of the residual: on facets nothing smaller is worth another round
CLEARLY = 0.5  # a mirrored mat that fits the marks with less than this share of the residual is meant


def anchored(geodesics: Geodesics, mat: Mat, marks: Marks, spine: Way = "rows") -> Anchor:
    """Place and heading of the mat's middle for which the marks, spread along lines, miss their points least.

    Gauss-Newton over a shift along the surface and a turn. It starts where each mark in turn is put onto its point and
    aimed at its neighbour, and goes on from the best. Three marks that are not in line show a mat that is the other way
    up, which is refused.
    """
    marks.on(mat)
    anchor, rms = _fitted(geodesics, mat, marks, spine)
    arms = marks.cells - marks.cells.mean(axis=0)
    if rms > 0.1 * min(mat.pitch) and np.linalg.matrix_rank(arms, 1e-6 * float(np.abs(arms).max())) == 2:
        other = Mat(mat.rows, mat.columns, mat.pitch, not mat.mirrored)
        try:
            _, turned = _fitted(geodesics, other, marks, spine)
        except ValueError:
            turned = np.inf
        if turned < CLEARLY * rms:
            word = "not mirrored" if mat.mirrored else "mirrored"
            raise ValueError(
                f"the marks fit a mat that is {word}: rms {1e3 * turned:.1f} mm instead of {1e3 * rms:.1f} mm; "
                "is the mat seen from its other side, or do the faces look inwards?"
            )
    return anchor


def _fitted(geodesics: Geodesics, mat: Mat, marks: Marks, spine: Way) -> tuple[Anchor, float]:
    """The best anchor and the rms of its misses [m]."""
    goals = geodesics.nearest(marks.points)

    def missed(anchor: Anchor) -> Float[np.ndarray, " n"]:
        return np.asarray((marked(geodesics, mat, marks, anchor, spine) - goals.point).ravel())

    starts = [_aimed(geodesics, mat, marks, goals, k) for k in range(len(marks.cells))]
    rated = [(_size(missed(start)), k) for k, start in enumerate(starts) if start.place.on[0]]
    if not rated or not min(rated)[0] < np.inf:
        raise ValueError(
            "the mat runs off the surface before it reaches its marks; check the pitch, the unit, the scan"
        )
    best, which = min(rated)
    anchor = starts[which]
    for _ in range(ROUNDS):
        step = _newton(geodesics, anchor, missed)
        for _ in range(HALVINGS):
            trial = anchor.carried(geodesics, float(step[0]), float(step[1])).turned(geodesics, float(step[2]))
            size = _size(missed(trial)) if trial.place.on[0] else np.inf
            if size < best:
                break
            step *= 0.5
        else:
            break
        small = np.abs(step).max() < SETTLED or size > (1.0 - GAIN) * best
        anchor, best = trial, size
        if small:
            break
    return anchor, best / float(np.sqrt(len(marks.cells)))


def marked(
    geodesics: Geodesics, mat: Mat, marks: Marks, anchor: Anchor, spine: Way = "rows"
) -> Float[np.ndarray, "k 3"]:
    """Where the marks come to lie [m]; NaN where that is off the surface."""
    ahead, aside = mat.away(marks.cells).T
    each = np.arange(len(marks.cells))
    return np.asarray(spread(geodesics, anchor, mat, ahead, aside, spine).point[each, each])


def _size(miss: Float[np.ndarray, " n"]) -> float:
    length = float(np.linalg.norm(miss))
    return length if np.isfinite(length) else np.inf


def _aimed(geodesics: Geodesics, mat: Mat, marks: Marks, goals: SurfacePoints, k: int) -> Anchor:
    """The anchor that puts mark k onto its point and the nearest other one of the mat into its direction."""
    arms = mat.away(marks.cells) - mat.away(marks.cells)[k]
    far = np.linalg.norm(arms, axis=1)
    other = int(np.argmin(np.where(far > 0.0, far, np.inf)))
    here = Anchor.at(geodesics, goals.point[k], goals.point[other] - goals.point[k])
    turn = -mat.hand * float(np.arctan2(arms[other, 1], arms[other, 0]))
    ahead, aside = -mat.away(marks.cells)[k]
    return here.turned(geodesics, turn).carried(geodesics, float(ahead), float(mat.hand * aside))


def _newton(geodesics: Geodesics, anchor: Anchor, missed: Missed) -> Float[np.ndarray, " 3"]:
    """Gauss-Newton step (ahead, aside, turn); differences across an end of the surface count as nothing."""
    rows = []
    for k in range(3):
        ends = []
        for sign in (1.0, -1.0):
            x = np.zeros(3)
            x[k] = sign * STEP
            moved = anchor.carried(geodesics, float(x[0]), float(x[1]))
            ends.append(missed(moved.turned(geodesics, float(x[2]))) if moved.place.on[0] else missed(anchor))
        rows.append(np.nan_to_num((ends[0] - ends[1]) / (2.0 * STEP)))
    step: Float[np.ndarray, " 3"] = np.linalg.lstsq(np.column_stack(rows), -missed(anchor), rcond=None)[0]
    return step

"""Laying a mat onto a surface so that its cells keep their size."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array, csr_array, eye_array
from scipy.sparse.linalg import spsolve

from geocontact.geometry.drape.belt import closed
from geocontact.geometry.drape.cells import Drape, measured
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.slip import motions
from geocontact.geometry.drape.spread import Anchor, Geodesics, Joins, SurfacePoints, Way, between, corners_at, spread

DEPENDENT = 1e-6  # of the largest singular value: motions that the marks do not tell apart


@dataclass(frozen=True, eq=False)
class LandmarkConstraints:
    """What is left of a mat's misses once they are seen as motions of the whole mat.

    With the misses m of all marks [m] and an orthonormal basis Q of what the motions of the mat do to its marks, Q^t m
    is nothing where no rigid move and turn along the surface brings the marks nearer to their points. The rest of m is
    what the marks contradict each other by, and pulls at nothing.

    Parameters
    ----------
    matrix
        Q^t times the shares of the nodes in the marks.
    goal
        Q^t times the places of the marks [m].
    """

    matrix: csr_array
    goal: Float[np.ndarray, " m"]

    def miss(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " m"]:
        """Miss of the mat with these nodes [m]."""
        return np.asarray(self.matrix @ points.ravel() - self.goal)

    def jacobian(self, axes: Float[np.ndarray, "n 2 3"]) -> csr_array:
        """Jacobian of the miss, by moves of the nodes along two axes each."""
        n = len(axes)
        node, way, x = np.meshgrid(np.arange(n), np.arange(2), np.arange(3), indexing="ij")
        along = coo_array((axes.ravel(), ((3 * node + x).ravel(), (2 * node + way).ravel())), shape=(3 * n, 2 * n))
        return csr_array(self.matrix @ along.tocsr())


def landmark_constraints(
    geodesics: Geodesics, mat: Mat, nodes: SurfacePoints, marks: Marks, owner: Int[np.ndarray, " n"], belt: Way | None
) -> LandmarkConstraints:
    """By the marks that lie on the surface with all corners of their cells; directions as the mat lies now."""
    index, share = corners_at(nodes.face.shape, marks.cells)
    there = (nodes.on.ravel()[index] | (share == 0.0)).all(axis=1)
    ways = motions(mat, nodes.point, marks.cells, belt)
    there &= np.isfinite(ways).all(axis=(0, 2))
    count = int(there.sum())
    u, size, _ = np.linalg.svd(ways[:, there].reshape(len(ways), -1).T, full_matrices=False)
    basis = u[:, size > DEPENDENT * size.max(initial=0.0)].T
    mark, corner = np.nonzero(share[there])
    row = 3 * mark[:, None] + np.arange(3)
    column = 3 * owner[index[there]][mark, corner][:, None] + np.arange(3)
    value = np.repeat(share[there][mark, corner], 3)
    shares = coo_array((value, (row.ravel(), column.ravel())), shape=(3 * count, 3 * len(owner)))
    goal = geodesics.nearest(marks.points[there]).point.ravel() if count else np.zeros(0)
    return LandmarkConstraints(csr_array(csr_array(basis) @ shares.tocsr()), basis @ goal)


SHEAR = 0.05  # stiffness of the diagonals over that of the sides: cloth is sheared much more easily than stretched
STAYS = 0.003  # stiffness that holds each corner where it was spread, over that of the sides, as a root
EVEN = 1e-10  # of a side: nothing to even out
SETTLED = 1e-6  # of the pitch, largest move of a round
ROUNDS = 40
GAIN = 1e-3  # of the sum of squares: less is not worth another round
DAMPING = 1e-6
STIFF = 1e6  # damping at which there is nothing more to gain
STRIDE = 0.25  # of the pitch, largest move


@dataclass(frozen=True, eq=False)
class Springs:
    """Pairs of nodes (flat indices), the length at which each rests [m], and the root of its stiffness."""

    start: Int[np.ndarray, " e"]
    goal: Int[np.ndarray, " e"]
    rest: Float[np.ndarray, " e"]
    weight: Float[np.ndarray, " e"]


def relaxed(
    geodesics: Geodesics, mat: Mat, nodes: SurfacePoints, belt: Way | None = None, marks: Marks | None = None
) -> SurfacePoints:
    """Corners moved along the surface until sides differ least from the pitch, and diagonals, weakly, from theirs.

    Least squares over all corners that lie on the surface, by damped Gauss-Newton. A straightest line of length L from
    a to b grows by db . t_b - da . t_a when its ends move, t the unit directions of the line there (first variation of
    arc length), so the derivative is exact. With soft diagonals the result nears a Chebyshev net, whose sides keep the
    pitch and whose angles turn by the integral of the Gaussian curvature (Hazzidakis 1879). A mat that fits already is
    returned as it is. Weak springs hold every corner where it was spread, and marks, as firmly as sides are, the mat as
    a whole: it does not slide or turn away from them to where it would fit better, and is not bent towards them either.
    """
    if belt is not None:
        nodes = closed(geodesics, mat, nodes, belt)
    flat = SurfacePoints(nodes.face.ravel(), nodes.point.reshape(-1, 3))
    owner = _owner(nodes.face.shape, belt)
    springs = _springs(mat, nodes.face.shape, flat, owner)
    damping = DAMPING
    spread_to = flat.point
    hold = None if marks is None else landmark_constraints(geodesics, mat, nodes, marks, owner, belt)
    residual, joins = _residual(geodesics, springs, flat)
    for _ in range(ROUNDS):
        if not len(residual) or np.abs(residual / springs.rest).max() < EVEN:
            break
        axes = _axes(geodesics, flat)
        astray = np.nan_to_num(flat.point - spread_to)
        shift = _step(springs, joins, residual, axes, _pulls(hold, flat, axes, astray), damping)
        size = float(np.linalg.norm(shift, axis=1).max())
        shift *= min(1.0, STRIDE * min(mat.pitch) / size) if size > 0.0 else 1.0
        trial = geodesics.moved(flat, shift)
        trial = SurfacePoints(
            np.where(trial.on, trial.face, flat.face), np.where(trial.on[:, None], trial.point, flat.point)
        )
        after, joins_after = _residual(geodesics, springs, trial)
        before, now = (_energy(r, p.point, spread_to, hold) for r, p in ((residual, flat), (after, trial)))
        if not now < before:
            damping *= 10.0
            if damping > STIFF:
                break
            continue
        little = now > (1.0 - GAIN) * before
        flat, residual, joins, damping = trial, after, joins_after, max(0.1 * damping, DAMPING)
        if little or size < SETTLED * min(mat.pitch):
            break
    flat = SurfacePoints(flat.face[owner], flat.point[owner])
    return SurfacePoints(flat.face.reshape(nodes.face.shape), flat.point.reshape(nodes.point.shape))


def _owner(shape: tuple[int, ...], belt: Way | None) -> Int[np.ndarray, " n"]:
    """Which node stands for each: itself, or the first of its row or column for the last of a belt."""
    index = np.arange(shape[0] * shape[1]).reshape(shape)
    if belt == "rows":
        index[-1] = index[0]
    elif belt == "columns":
        index[:, -1] = index[:, 0]
    return index.ravel()


def _springs(mat: Mat, shape: tuple[int, ...], flat: SurfacePoints, owner: Int[np.ndarray, " n"]) -> Springs:
    """Sides and diagonals between nodes that are on the surface, each once."""
    index = np.arange(shape[0] * shape[1]).reshape(shape)
    diagonal = float(np.hypot(*mat.pitch))
    parts = [
        (index[:-1], index[1:], mat.pitch[0], 1.0),
        (index[:, :-1], index[:, 1:], mat.pitch[1], 1.0),
        (index[:-1, :-1], index[1:, 1:], diagonal, np.sqrt(SHEAR)),
        (index[1:, :-1], index[:-1, 1:], diagonal, np.sqrt(SHEAR)),
    ]
    start = owner[np.concatenate([a.ravel() for a, _, _, _ in parts])]
    goal = owner[np.concatenate([b.ravel() for _, b, _, _ in parts])]
    rest = np.concatenate([np.full(a.size, length) for a, _, length, _ in parts])
    weight = np.concatenate([np.full(a.size, share) for a, _, _, share in parts])
    pairs = np.column_stack([start, goal])
    _, first = np.unique(pairs, axis=0, return_index=True)
    first = np.sort(first)
    first = first[flat.on[start[first]] & flat.on[goal[first]]]
    return Springs(start[first], goal[first], rest[first], weight[first])


def _residual(geodesics: Geodesics, springs: Springs, flat: SurfacePoints) -> tuple[Float[np.ndarray, " e"], Joins]:
    """Weighted change of each spring's length [m]; 0 where no straightest line was found."""
    joins = geodesics.joined(
        SurfacePoints(flat.face[springs.start], flat.point[springs.start]),
        SurfacePoints(flat.face[springs.goal], flat.point[springs.goal]),
    )
    return np.nan_to_num(springs.weight * (joins.length - springs.rest)), joins


def _axes(geodesics: Geodesics, flat: SurfacePoints) -> Float[np.ndarray, "n 2 3"]:
    """Two unit vectors along the surface at each place; zero off it."""
    normal = np.nan_to_num(geodesics.normal(flat))
    least = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(normal, least)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-300)
    return np.stack([first, np.cross(normal, first)], axis=1)


def _step(
    springs: Springs,
    joins: Joins,
    residual: Float[np.ndarray, " e"],
    axes: Float[np.ndarray, "n 2 3"],
    pulls: tuple[csr_array, Float[np.ndarray, " two_n"]],
    damping: float,
) -> Float[np.ndarray, "n 3"]:
    """Damped Gauss-Newton move of every node [m]."""
    e = np.arange(len(residual))
    ahead = springs.weight[:, None] * np.nan_to_num(np.einsum("eax,ex->ea", axes[springs.goal], joins.arriving))
    behind = -springs.weight[:, None] * np.nan_to_num(np.einsum("eax,ex->ea", axes[springs.start], joins.leaving))
    row = np.concatenate([e, e, e, e])
    column = np.concatenate([2 * springs.goal, 2 * springs.goal + 1, 2 * springs.start, 2 * springs.start + 1])
    value = np.concatenate([*ahead.T, *behind.T])
    jacobian = coo_array((value, (row, column)), shape=(len(e), 2 * len(axes))).tocsc()
    stiffness = (jacobian.T @ jacobian + pulls[0] + damping * eye_array(2 * len(axes), format="csc")).tocsc()
    move = spsolve(stiffness, -(jacobian.T @ residual) - pulls[1]).reshape(-1, 2)
    return np.asarray(np.einsum("na,nax->nx", move, axes))


def _pulls(
    hold: LandmarkConstraints | None,
    flat: SurfacePoints,
    axes: Float[np.ndarray, "n 2 3"],
    astray: Float[np.ndarray, "n 3"],
) -> tuple[csr_array, Float[np.ndarray, " two_n"]]:
    """Stiffness and force [m] of what holds the corners: each where it was spread, and all of them at the marks."""
    stiffness = csr_array(STAYS**2 * eye_array(2 * len(axes), format="csr"))
    force = STAYS**2 * np.einsum("nax,nx->na", axes, astray).ravel()
    if hold is None:
        return stiffness, force
    jacobian = hold.jacobian(axes)
    return csr_array(stiffness + jacobian.T @ jacobian), force + jacobian.T @ hold.miss(flat.point)


def _energy(
    residual: Float[np.ndarray, " e"],
    points: Float[np.ndarray, "n 3"],
    spread_to: Float[np.ndarray, "n 3"],
    hold: LandmarkConstraints | None,
) -> float:
    """Energy of all springs and of the holds [m^2]."""
    miss = np.zeros(0) if hold is None else hold.miss(points)
    astray = np.nan_to_num(points - spread_to)
    return float(residual @ residual) + STAYS**2 * float((astray**2).sum()) + float(miss @ miss)


Missed = Callable[[Anchor], Float[np.ndarray, " n"]]

STEP = 1e-4  # m and rad, of the central differences
ANCHOR_SETTLED = 1e-7  # m and rad
ANCHOR_ROUNDS = 30
HALVINGS = 6
ANCHOR_GAIN = 1e-6  # of the residual: on facets nothing smaller is worth another round
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
    for _ in range(ANCHOR_ROUNDS):
        step = _newton(geodesics, anchor, missed)
        for _ in range(HALVINGS):
            trial = anchor.carried(geodesics, float(step[0]), float(step[1])).turned(geodesics, float(step[2]))
            size = _size(missed(trial)) if trial.place.on[0] else np.inf
            if size < best:
                break
            step *= 0.5
        else:
            break
        small = np.abs(step).max() < ANCHOR_SETTLED or size > (1.0 - ANCHOR_GAIN) * best
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


def lay(geodesics: Geodesics, mat: Mat, at: Marks | Anchor, belt: Way | None = None, settle: bool = True) -> Drape:
    """The mat on the surface: spread along straightest lines from its middle, then evened out; marks hold it there.

    Parameters
    ----------
    at
        Two marks or more of the mat on the body, or where its middle lies and which way its rows run.
    belt
        The direction of the mat that goes once around the body and meets itself; its end is put onto its beginning.
        None: the mat has two ends, which may lie on each other on a thin body; such cells are reported as folded.
    settle
        Whether the spread mat is evened out. Where the surface can be laid flat there is nothing to even out.
    """
    spine: Way = _spine(mat, belt)
    anchor = at if isinstance(at, Anchor) else anchored(geodesics, mat, at, spine)
    if not anchor.place.on[0]:
        raise ValueError("the middle of the mat is not on the surface")
    row, column = np.arange(mat.rows + 1.0), np.arange(mat.columns + 1.0)
    ahead = (row - mat.middle[0]) * mat.pitch[0]
    aside = (column - mat.middle[1]) * mat.pitch[1]
    nodes = spread(geodesics, anchor, mat, ahead, aside, spine)
    if settle or belt:
        nodes = relaxed(geodesics, mat, nodes, belt, at if isinstance(at, Marks) else None)
    misses = None
    if isinstance(at, Marks):
        misses = np.linalg.norm(between(nodes, at.cells) - at.points, axis=1)
    return measured(geodesics, mat, nodes, misses)


def _spine(mat: Mat, belt: Way | None) -> Way:
    """Ribs are the short side of the mat, where they drift apart least; those of a belt go around."""
    if belt is not None:
        return "columns" if belt == "rows" else "rows"
    return "rows" if mat.rows * mat.pitch[0] >= mat.columns * mat.pitch[1] else "columns"

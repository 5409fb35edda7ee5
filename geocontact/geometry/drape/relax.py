"""Evening out a mat that cannot lie flat: its cells' sides are brought back to the pitch, as threads of a cloth are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array, csr_array, eye_array
from scipy.sparse.linalg import spsolve

from geocontact.geometry.drape.belt import closed
from geocontact.geometry.drape.geodesics import Geodesics, Joins, SurfacePoints
from geocontact.geometry.drape.landmark_constraints import LandmarkConstraints, landmark_constraints
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Way

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
    """Of all springs and of the holds [m^2]."""
    miss = np.zeros(0) if hold is None else hold.miss(points)
    astray = np.nan_to_num(points - spread_to)
    return float(residual @ residual) + STAYS**2 * float((astray**2).sum()) + float(miss @ miss)

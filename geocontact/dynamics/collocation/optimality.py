"""The optimality system of a solved problem, how sharply it tells the parameters, and how the solution follows them.

At a minimum with Lagrangian L and constraints g the second derivative of the least cost by the parameters is the Schur
complement of everything else in the matrix [[L_zz, g_zᵀ], [g_z, 0]], so that its inverse is that matrix' inverse at the
parameters (Nocedal & Wright (2006), Numerical Optimization, 16.1). Where the cost is twice a negative logarithm of a
likelihood, twice this inverse is the parameters' covariance (Laplace's approximation).

With z the variables that move, y the parameters, L the Lagrangian and g the constraints, the conditions of a minimum
L_z = 0 and g = 0 hold at every y, so that

    [ L_zz  g_zᵀ ; g_z  0 ] [ dz/dy ; dλ/dy ] = -[ L_zy ; g_y ]

(implicit function theorem; Fiacco (1983), Introduction to Sensitivity and Stability Analysis in Nonlinear Programming,
3.2). Bounds of states and controls count as not reached.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.dynamics.collocation.blocks import sparse_program
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.dynamics.collocation.transcription import Transcription, scales_from


@dataclass(frozen=True, eq=False)
class OptimalitySystem:
    """Optimality conditions of all variables, scaled as the transcription scales them.

    Parameters
    ----------
    on
        Where each variable stands.
    hessian, slope
        Of the Lagrangian, and the constraints' first derivatives; sparse, by columns.
    """

    on: Transcription
    hessian: Any
    slope: Any

    def solved(self, moves: Bool[np.ndarray, " z"], right: Float[np.ndarray, "k r"]) -> Float[np.ndarray, "k r"]:
        """Answer of [[L_zz, g_zᵀ], [g_z, 0]] of the variables that move. ValueError where it is singular.

        Without parameters and durations the matrix is a band in the order of time: that of reverse Cuthill-McKee finds
        it, and factors take a fifth of the time that they take in SuperLU's own order. Durations stand in every row of
        their trial. They come last, where they fill nothing: among the others they make a band as wide as the trial.
        """
        from scipy.sparse import bmat, csc_matrix
        from scipy.sparse.linalg import splu

        slope = self.slope[:, moves]
        matrix = csc_matrix(bmat([[self.hessian[moves][:, moves], slope.T], [slope, None]]))
        order = self._order(matrix, moves)
        answer = np.empty(right.shape)
        try:
            answer[order] = splu(matrix[order][:, order].tocsc(), permc_spec="NATURAL").solve(right[order])
        except RuntimeError as error:
            raise ValueError("the parameters are not identified: the optimality system is singular") from error
        return answer

    def _order(self, matrix: Any, moves: Bool[np.ndarray, " z"]) -> Int[np.ndarray, " k"]:
        from scipy.sparse.csgraph import reverse_cuthill_mckee

        everywhere = np.zeros(self.on.size, bool)
        everywhere[self.on.first[:-1]] = True
        last = np.zeros(matrix.shape[0], bool)
        last[: int(moves.sum())] = everywhere[moves]
        rest = np.flatnonzero(~last)
        band = reverse_cuthill_mckee(matrix[rest][:, rest].tocsr(), symmetric_mode=True)
        return np.asarray(np.r_[rest[band], np.flatnonzero(last)])


def optimality_system(problem: ControlProblem, found: CollocationResult) -> OptimalitySystem:
    """At a solution, whose multipliers are used."""
    on = Transcription(problem, found.motions[0].scheme, found.meshes, scales_from(problem), by_all=True)
    program = sparse_program(on.blocks(), on.size)
    z = on.again(found.p, found.motions)
    upper = program.hessian(z, [], 1.0, found.multipliers[1]).sparse()
    slope = program.jacobian(z, [])[1].sparse().tocsc()
    hessian = (upper + upper.T).tocsc()
    hessian.setdiag(upper.diagonal())
    return OptimalitySystem(on, hessian, slope)


def inverse_reduced_hessian(
    problem: ControlProblem, found: CollocationResult, held: Sequence[bool] | None = None
) -> Float[np.ndarray, "p p"]:
    """Inverse of the second derivative of the least cost by the parameters; 0 where one is held.

    Bounds of states and controls count as not reached. ValueError where the matrix is singular: parameters or controls
    that neither data nor a prior tell, or no minimum.

    Parameters
    ----------
    found
        Solved; its multipliers are used.
    held
        Which parameters do not move, beside those whose bounds are equal: such as those that end on a bound.
    """
    system = optimality_system(problem, found)
    on = system.on
    low, high = on.bounds()
    moves = low < high
    free = np.flatnonzero(moves[: on.np] & ~(np.zeros(on.np, bool) if held is None else np.array(held, bool)))
    moves[: on.np] = False
    # parameters stand in every row: left in the matrix they fill its factors
    right = np.vstack([system.hessian[moves][:, free].toarray(), system.slope[:, free].toarray()])
    reduced = system.hessian[free][:, free].toarray() - right.T @ system.solved(moves, right)
    inverse = np.zeros((on.np, on.np))
    try:
        columns = np.linalg.inv(0.5 * (reduced + reduced.T))
    except np.linalg.LinAlgError as error:
        raise ValueError("the parameters are not identified: the cost has no minimum there") from error
    inverse[np.ix_(free, free)] = columns * np.outer(on.scales.p[free], on.scales.p[free])
    if not np.isfinite(inverse).all() or (np.diag(inverse)[free] <= 0.0).any():
        raise ValueError("the parameters are not identified: the cost has no minimum there")
    return inverse


@dataclass(frozen=True, eq=False)
class MotionResponse:
    """Response of one trial, derivatives by each parameter.

    Parameters
    ----------
    states
        At the starts and the points of the intervals, for each parameter.
    controls
        At the points.
    """

    states: Float[np.ndarray, "p m d1 x"]
    controls: Float[np.ndarray, "p m d u"]


def responses(problem: ControlProblem, found: CollocationResult) -> tuple[MotionResponse, ...]:
    """Response of each trial of a problem whose parameters are all given. ValueError where the system is singular."""
    system = optimality_system(problem, found)
    on = system.on
    low, high = on.bounds()
    moves = low < high
    moves[: on.np] = False
    right = -np.vstack([system.hessian[moves][:, : on.np].toarray(), system.slope[:, : on.np].toarray()])
    answer = system.solved(moves, right)[: int(moves.sum())]
    each = []
    for k in range(on.np):
        change = np.zeros(on.size)
        change[moves] = answer[:, k] / on.scales.p[k]
        each.append(on.unpacked(change)[1])
    return tuple(
        MotionResponse(np.stack([one[j].states for one in each]), np.stack([one[j].controls for one in each]))
        for j in range(len(problem.trials))
    )

"""How sharply the cost tells the parameters once states and controls have followed: the reduced Hessian's inverse.

At a minimum with Lagrangian L and constraints g the second derivative of the least cost by the parameters is the Schur
complement of everything else in the matrix [[L_zz, g_zᵀ], [g_z, 0]], so that its inverse is that matrix' inverse at the
parameters (Nocedal & Wright (2006), Numerical Optimization, 16.1). Where the cost is twice a negative logarithm of a
likelihood, twice this inverse is the parameters' covariance (Laplace's approximation).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.collocation.blocks import sparse_program
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.dynamics.collocation.transcription import Transcription, scales_from

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


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
    from scipy.sparse import bmat, csc_matrix

    on = Transcription(problem, found.motions[0].scheme, found.meshes, scales_from(problem))
    program = sparse_program(on.blocks(), on.size)
    durations = [float(m.breaks[-1] - m.breaks[0]) for m in found.motions]
    z = on.packed(found.p, durations, [m.state for m in found.motions], [m.control for m in found.motions])
    moves = _moves(on, np.zeros(on.np, bool) if held is None else np.array(held, bool))
    upper = program.hessian(z, [], 1.0, found.multipliers[1]).sparse()
    slope = program.jacobian(z, [])[1].sparse().tocsc()[:, moves]
    hessian = (upper + upper.T).tocsc()
    hessian.setdiag(upper.diagonal())
    matrix = csc_matrix(bmat([[hessian[moves][:, moves], slope.T], [slope, None]]))
    free = np.flatnonzero(moves[: on.np])
    columns = _leading_inverse(matrix, len(free))
    inverse = np.zeros((on.np, on.np))
    inverse[np.ix_(free, free)] = 0.5 * (columns + columns.T) * np.outer(on.scales.p[free], on.scales.p[free])
    if not np.isfinite(inverse).all() or (np.diag(inverse)[free] <= 0.0).any():
        raise ValueError("the parameters are not told: the cost has no minimum there")
    return inverse


def _leading_inverse(matrix: csc_matrix, count: int) -> Float[np.ndarray, "p p"]:
    """Leading block of the inverse of a symmetric matrix; ValueError where it is singular.

    All but the first `count` rows, which reach everywhere, are a band in the order of time: that of reverse
    Cuthill-McKee finds it, and factors take a fifth of the time that they take in SuperLU's own order.
    """
    from scipy.sparse.csgraph import reverse_cuthill_mckee
    from scipy.sparse.linalg import splu

    band = reverse_cuthill_mckee(matrix[count:, count:].tocsr(), symmetric_mode=True)
    order = np.concatenate([count + band, np.arange(count)])
    right = np.zeros((len(order), count))
    right[np.arange(-count, 0), np.arange(count)] = 1.0
    try:
        solved = splu(matrix[order][:, order].tocsc(), permc_spec="NATURAL").solve(right)
    except RuntimeError as error:
        raise ValueError("the parameters are not told: the optimality system is singular") from error
    leading: Float[np.ndarray, "p p"] = solved[len(order) - count :]
    return leading


def _moves(on: Transcription, held: Bool[np.ndarray, " p"]) -> Bool[np.ndarray, " z"]:
    """Variables that are not fixed."""
    low, high = on.bounds()
    moves: Bool[np.ndarray, " z"] = low < high
    moves[: on.np] &= ~held
    return moves

"""How sharply the cost tells the parameters once states and controls have followed: the reduced Hessian's inverse.

At a minimum with Lagrangian L and constraints g the second derivative of the least cost by the parameters is the Schur
complement of everything else in the matrix [[L_zz, g_zᵀ], [g_z, 0]], so that its inverse is that matrix' inverse at the
parameters (Nocedal & Wright (2006), Numerical Optimization, 16.1). Where the cost is twice a negative logarithm of a
likelihood, twice this inverse is the parameters' covariance (Laplace's approximation).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.collocation.optimality import optimality_system
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.dynamics.collocation.transcription import Transcription


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
    moves = _moves(on, np.zeros(on.np, bool) if held is None else np.array(held, bool))
    free = np.flatnonzero(moves[: on.np])
    right = np.zeros((int(moves.sum()) + system.slope.shape[0], len(free)))
    right[np.arange(len(free)), np.arange(len(free))] = 1.0
    columns = system.solved(moves, right)[: len(free)]
    inverse = np.zeros((on.np, on.np))
    inverse[np.ix_(free, free)] = 0.5 * (columns + columns.T) * np.outer(on.scales.p[free], on.scales.p[free])
    if not np.isfinite(inverse).all() or (np.diag(inverse)[free] <= 0.0).any():
        raise ValueError("the parameters are not told: the cost has no minimum there")
    return inverse


def _moves(on: Transcription, held: Bool[np.ndarray, " p"]) -> Bool[np.ndarray, " z"]:
    """Variables that are not fixed."""
    low, high = on.bounds()
    moves: Bool[np.ndarray, " z"] = low < high
    moves[: on.np] &= ~held
    return moves

"""How sharply the cost tells the parameters once states and controls have followed: the reduced Hessian's inverse.

At a minimum with Lagrangian L and constraints g the second derivative of the least cost by the parameters is the Schur
complement of everything else in the matrix [[L_zz, g_zᵀ], [g_z, 0]], so that its inverse is that matrix' inverse at the
parameters (Nocedal & Wright (2006), Numerical Optimization, 16.1). Where the cost is twice a negative logarithm of a
likelihood, twice this inverse is the parameters' covariance (Laplace's approximation).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.optimality import optimality_system
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult


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
        raise ValueError("the parameters are not told: the cost has no minimum there") from error
    inverse[np.ix_(free, free)] = columns * np.outer(on.scales.p[free], on.scales.p[free])
    if not np.isfinite(inverse).all() or (np.diag(inverse)[free] <= 0.0).any():
        raise ValueError("the parameters are not told: the cost has no minimum there")
    return inverse

"""The optimality system of a solved problem: second derivatives of its Lagrangian beside those of its constraints."""

from __future__ import annotations

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
    """Of all variables, scaled as the transcription scales them.

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
            raise ValueError("the parameters are not told: the optimality system is singular") from error
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
    on = Transcription(problem, found.motions[0].scheme, found.meshes, scales_from(problem))
    program = sparse_program(on.blocks(), on.size)
    z = on.again(found.p, found.motions)
    upper = program.hessian(z, [], 1.0, found.multipliers[1]).sparse()
    slope = program.jacobian(z, [])[1].sparse().tocsc()
    hessian = (upper + upper.T).tocsc()
    hessian.setdiag(upper.diagonal())
    return OptimalitySystem(on, hessian, slope)

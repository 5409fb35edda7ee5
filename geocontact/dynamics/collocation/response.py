"""How a solution follows its parameters: derivatives of states and controls, from the optimality system.

With z the variables that move, y the parameters, L the Lagrangian and g the constraints, the conditions of a minimum
L_z = 0 and g = 0 hold at every y, so that

    [ L_zz  g_zᵀ ; g_z  0 ] [ dz/dy ; dλ/dy ] = -[ L_zy ; g_y ]

(implicit function theorem; Fiacco (1983), Introduction to Sensitivity and Stability Analysis in Nonlinear Programming,
3.2). Bounds of states and controls count as not reached.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.optimality import optimality_system
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult


@dataclass(frozen=True, eq=False)
class MotionResponse:
    """Of one trial, derivatives by each parameter.

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
    """Of each trial of a problem whose parameters are all given. ValueError where the system is singular."""
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

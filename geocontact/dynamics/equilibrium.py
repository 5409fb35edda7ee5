"""Static equilibrium of equations: where nothing accelerates and no memory changes.

Pseudo-transient continuation with switched evolution relaxation (Kelley & Keyes 1998, Convergence analysis of
pseudo-transient continuation, SIAM J Numer Anal 35, 508-523): an overdamped motion m q' = F(q) followed by implicit
steps that grow as the forces shrink, until they are Newton's. It ends where a damped motion ends, in a stable
equilibrium, and a coordinate that nothing holds stays where it was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.equations import Equations

if TYPE_CHECKING:
    from casadi import Function

Vector = Float[np.ndarray, " _"]
FIRST = 1e-3
"""First step [s] of the overdamped motion."""
SLOWEST, WIDEST = 0.2, 1e9
"""Least factor a step changes by when forces grow, and the longest step [s]."""
TURN = 0.1
"""Most that a coordinate [rad, m] changes in a step; steps that would go further are cut."""


class Equilibrium:
    """Searches for static equilibria of some equations.

    Parameters
    ----------
    equations
        Rates are 0 in equilibrium; so must be the inputs that are rates.
    """

    def __init__(self, equations: Equations) -> None:
        self.equations = equations
        self._function = _residual(equations)

    def find(
        self,
        start: tuple[Vector, Vector],
        *,
        inputs: Vector | None = None,
        parameters: Vector | None = None,
        tolerance: float = 1e-9,
        most: int = 500,
    ) -> tuple[Vector, Vector]:
        """q and z in equilibrium, from those at the start.

        Parameters
        ----------
        tolerance
            Largest generalised force that is left [N m, N], and rate of a memory [its unit/s].
        most
            Steps before ArithmeticError says what is left and where.
        """
        e, n = self.equations, len(self.equations.names)
        w = np.zeros(e.w.numel()) if inputs is None else np.asarray(inputs, float)
        p = np.zeros(e.p.numel()) if parameters is None else np.asarray(parameters, float)
        x = np.concatenate(start).astype(float)
        h, before = FIRST, np.inf
        for _ in range(most):
            residual, slope, mass = (np.array(each, float) for each in self._function(x, w, p))
            left = float(np.abs(residual).max(initial=0.0))
            if left <= tolerance:
                return x[:n], x[n:]
            if not np.isfinite(left):
                break
            h = min(h * float(np.clip(before / left, SLOWEST, 10.0)), WIDEST) if np.isfinite(before) else h
            before = left
            step = np.linalg.solve(mass / h - slope, residual.ravel())
            far = float(np.abs(step[:n]).max(initial=0.0))
            x = x + step * min(1.0, TURN / far if far > 0.0 else 1.0)
        worst = int(np.argmax(np.abs(residual)))
        where = f"coordinate {e.names[worst]}" if worst < n else f"memory {worst - n + 1}"
        raise ArithmeticError(f"no static equilibrium is found: {left:.3g} is left along {where}")


def _residual(e: Equations) -> Function:
    """((q, z), w, p) to forces and growths without motion, their derivatives, and the mass of the artificial motion."""
    from casadi import DM, SX, Function, densify, diagcat, jacobian, substitute, vertcat

    x = vertcat(e.q, e.z)
    still = substitute(vertcat(e.force, e.growth), e.u, SX.zeros(e.u.shape))
    mass = diagcat(e.mass, DM.eye(e.z.numel())) if e.z.numel() else e.mass
    outputs = [densify(still), densify(jacobian(still, x)), densify(mass)]
    return Function("equilibrium", [x, e.w, e.p], outputs)

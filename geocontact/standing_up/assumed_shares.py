"""What the interval of a phase's parameters owes to what is taken as given: numbers that are held, sizes of the jerk.

At the least cost L_z = 0 and g = 0 hold for any y that is given, so that the answer z follows it by the optimality
system, [[L_zz, g_zᵀ], [g_z, 0]] [dz; dλ] = -[L_zy; g_y] dy (Fiacco (1983), 3.2). For a held parameter both columns are
those of the system itself. The jerk of coordinate i counts as ∫ (j_i/σ_i)² dt, so that the derivative of its gradient
by ln σ is -2 times it. With C the covariance of what is held, as the phase before found it, and s the standard
deviation of each ln σ, errors of what is given move the answer with the covariance

    (dp/dy) C (dp/dy)ᵀ + s² Σ_g (dp/dln σ_g) (dp/dln σ_g)ᵀ

to first order, which adds to Laplace's. Sizes of the jerk are assumed within a factor `JERK_KNOWN`, those of the foot,
of the person's joints and of the exoskeleton's hinges each by itself: a light exoskeleton follows its straps with
another jerk than the person, and neither is white. Of a rise that a feedback controller drives instead of least jerk
the hinges' jerk was 100 to 200 rad/s³ and the person's joints' 9 to 24, where 60 are taken for both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.collocation.optimality import OptimalitySystem, optimality_system
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.phase import PhaseProblem

JERK_KNOWN = 2.0
"""Factor within which the size of the jerk is assumed, as one standard deviation; invented."""
FEET = 3
"""Coordinates of the foot, which come first."""


@dataclass(frozen=True, eq=False)
class AssumedShares:
    """How far what is searched follows what is given, and how well that is known.

    Parameters
    ----------
    by_held
        Derivatives by each held parameter; 0 for those that are sought or known exactly.
    by_jerk
        By the logarithms of the jerk's sizes: of the foot, of the person's joints, of the exoskeleton's hinges.
    covariance
        Of the held parameters.
    """

    by_held: Float[np.ndarray, "p p"]
    by_jerk: Float[np.ndarray, "p g"]
    covariance: Float[np.ndarray, "p p"]

    @property
    def held(self) -> Float[np.ndarray, "p p"]:
        """Covariance of what is searched that the held parameters make."""
        return np.asarray(self.by_held @ self.covariance @ self.by_held.T)

    @property
    def jerk(self) -> Float[np.ndarray, "p p"]:
        """That the sizes of the jerk make."""
        return np.asarray(np.log(JERK_KNOWN) ** 2 * self.by_jerk @ self.by_jerk.T)

    @property
    def sd(self) -> Float[np.ndarray, " p"]:
        """Standard deviation of both together."""
        return np.asarray(np.sqrt(np.diag(self.held + self.jerk)))


def assumed_shares(
    phase: PhaseProblem, found: CollocationResult, covariance: Float[np.ndarray, "p p"], stays: Sequence[bool]
) -> AssumedShares:
    """Shares of a phase that was solved. ValueError where the optimality system is singular.

    Parameters
    ----------
    covariance
        Of the parameters that are held; rows of those that are sought and move are not looked at.
    stays
        Sought parameters that do not move, such as those on a bound: they count as held.
    """
    system = optimality_system(phase.control, found)
    on = system.on
    low, high = on.bounds()
    moves = low < high
    sought = moves[: on.np] & ~np.array(stays, bool)
    given = ~sought & (np.diag(covariance) > 0.0)
    by_held = system.hessian[:, : on.np][:, given].toarray(), system.slope[:, : on.np][:, given].toarray()
    pulls = _jerk_pulls(phase, found, system)
    by_jerk = -2.0 * pulls, np.zeros((system.slope.shape[0], pulls.shape[1]))
    along = _followed(system, sought, *(np.hstack(both) for both in zip(by_held, by_jerk, strict=True)))
    by_parameter = np.zeros((on.np, on.np))
    # of what is searched, not of its scaled stand-in
    by_parameter[:, given] = along[:, : int(given.sum())] / on.scales.p[given]
    return AssumedShares(by_parameter, along[:, int(given.sum()) :], covariance)


def _followed(
    system: OptimalitySystem,
    sought: Bool[np.ndarray, " p"],
    pull: Float[np.ndarray, "z y"],
    shift: Float[np.ndarray, "k y"],
) -> Float[np.ndarray, "p y"]:
    """Derivatives of the parameters by what is given, whose columns are L_zy and g_y; 0 where they do not move.

    By the Schur complement of states and controls: parameters stand in every row and would fill the factors.
    """
    on, free = system.on, np.flatnonzero(sought)
    low, high = on.bounds()
    moves = low < high
    moves[: on.np] = False
    right = np.vstack([system.hessian[moves][:, free].toarray(), system.slope[:, free].toarray()])
    answer = system.solved(moves, np.hstack([right, np.vstack([pull[moves], shift])]))
    reduced = system.hessian[free][:, free].toarray() - right.T @ answer[:, : len(free)]
    found = np.zeros((on.np, pull.shape[1]))
    found[free] = -np.linalg.solve(reduced, pull[free] - right.T @ answer[:, len(free) :])
    return np.asarray(found * on.scales.p[:, None])


def _jerk_pulls(phase: PhaseProblem, found: CollocationResult, system: OptimalitySystem) -> Float[np.ndarray, "z g"]:
    """Gradient of ∫ (j/σ)² dt by the scaled variables, by groups of coordinates."""
    from casadi import Function, gradient

    s, on, n = phase.control.system, system.on, len(phase.control.system.names[0]) // 3
    slope = Function("slope", [s.u], [gradient(phase.terms["jerk"], s.u)])
    ends = [FEET, len(COORDINATES), n]
    groups = [range(a, b) for a, b in zip([0, *ends[:-1]], ends, strict=True) if b > a]
    columns = []
    for group in groups:
        pulled = []
        for motion in found.motions:
            weights = np.diff(motion.breaks)[:, None] * motion.scheme.weights
            u = motion.controls.reshape(-1, motion.controls.shape[2])
            by = slope.map(len(u))(u.T).full().T.reshape(motion.controls.shape) * weights[:, :, None]
            by[:, :, [k for k in range(by.shape[2]) if k not in group]] = 0.0
            still = np.zeros_like(motion.states)
            pulled.append(
                replace(motion, breaks=np.zeros_like(motion.breaks), states=still, controls=by, end=still[0, 0])
            )
        # as scaled variables they are divided by their scale where a derivative is multiplied by it
        columns.append(on.again(np.zeros(on.np), pulled) * on.scale**2)
    return np.stack(columns, axis=1)

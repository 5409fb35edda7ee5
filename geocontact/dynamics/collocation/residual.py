"""What is left of the equations between the collocation points, where nothing was asked of the polynomials."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion, MotionSamples
from geocontact.dynamics.collocation.problem import ControlledSystem, ControlledTrial

Vector = Float[np.ndarray, " _"]


def residuals(
    system: ControlledSystem, trial: ControlledTrial, at: MotionSamples, p: Vector
) -> tuple[Float[np.ndarray, "t x"], Float[np.ndarray, "t h"]]:
    """x' - rate, and the path, in their own units."""
    from casadi import Function

    both = Function("both", [system.x, system.u, system.w, system.p], [system.rate, system.path]).map(len(at.time))
    given = (at.state.T, at.control.T, trial.inputs(at.time).T, np.tile(p[:, None], (1, len(at.time))))
    rate, path = (np.array(each.full()) for each in both(*given))
    return at.rate - rate.T, path.T


def interval_residuals(
    system: ControlledSystem,
    trial: ControlledTrial,
    motion: CollocatedMotion,
    p: Vector,
    scale_x: Vector,
    scale_path: Vector,
) -> Vector:
    """Largest scaled residual of each interval, its ends too: of the states over its length, and of the path."""
    each = 5 * motion.scheme.degree + 1
    rate, path = residuals(system, trial, motion.sampled(each), p)
    lengths = np.repeat(np.diff(motion.breaks), each)[:, None]
    scaled = np.hstack([np.abs(rate) * lengths / scale_x, np.abs(path) / scale_path])
    largest: Vector = scaled.max(axis=1).reshape(-1, each).max(axis=1)
    return largest

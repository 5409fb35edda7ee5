"""What is left of the equations between the collocation points, where nothing was asked of the polynomials."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.problem import ControlledSystem, ControlledTrial

Vector = Float[np.ndarray, " _"]


def residuals(
    system: ControlledSystem, trial: ControlledTrial, motion: CollocatedMotion, p: Vector, time: Float[np.ndarray, " t"]
) -> tuple[Float[np.ndarray, "t x"], Float[np.ndarray, "t h"]]:
    """x' - rate, and the path, at times [s], in their own units."""
    from casadi import Function

    both = Function("both", [system.x, system.u, system.w, system.p], [system.rate, system.path]).map(len(time))
    x, u, w = motion.state(time), motion.control(time), trial.inputs(time)
    rate, path = (np.array(each.full()) for each in both(x.T, u.T, w.T, np.tile(p[:, None], (1, len(time)))))
    return motion.rate(time) - rate.T, path.T


def interval_residuals(
    system: ControlledSystem,
    trial: ControlledTrial,
    motion: CollocatedMotion,
    p: Vector,
    scale_x: Vector,
    scale_path: Vector,
) -> Vector:
    """Largest scaled residual of each interval: of the states over the interval's length, and of the path."""
    each = 5 * motion.scheme.degree
    rate, path = residuals(system, trial, motion, p, motion.times(each))
    lengths = np.repeat(np.diff(motion.breaks), each)[:, None]
    scaled = np.hstack([np.abs(rate) * lengths / scale_x, np.abs(path) / scale_path])
    largest: Vector = scaled.max(axis=1).reshape(-1, each).max(axis=1)
    return largest

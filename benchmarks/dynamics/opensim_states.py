"""States of OpenSim models for comparison with OpenSim, and forces by velocity from Lagrange's equations."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def states(model: Any, rng: Any, count: int) -> Any:
    """Coordinates about the middle of their ranges, half as wide; locked ones and those that follow as they are."""
    import numpy as np

    low, high = np.array([c.limits for c in model.coordinates]).T
    start = np.array([c.default for c in model.coordinates])
    wide = np.isfinite(low) & np.isfinite(high) & (high - low < 7.0)
    low, high = np.where(wide, low, start - 0.5), np.where(wide, high, start + 0.5)
    middle, span = 0.5 * (low + high), 0.5 * (high - low)
    turned = np.array([c.kind == "rotational" for c in model.coordinates])
    span = np.where(turned, np.minimum(span, 0.6), np.minimum(span, 0.1))
    middle = np.where(np.abs(middle - start) > span, np.clip(start, middle - span, middle + span), middle)
    values = middle + rng.uniform(-0.5, 0.5, (count, len(span))) * span
    locked = np.array([c.locked for c in model.coordinates])
    return closed(model, model.coupled(np.where(locked, start, values)))


def closed(model: Any, values: Any) -> Any:
    """States near these in which points of constraints lie on each other."""
    import numpy as np
    from scipy.optimize import least_squares

    if not model.pairs:
        return values

    def apart(q: Any) -> Any:
        poses = model.poses(q[None])
        ends = [[poses[body].apply(place)[0] for body, place in map(pair.ends, (0, 1))] for pair in model.pairs]
        return np.concatenate([one - other for one, other in ends])

    return np.array([least_squares(lambda q, near=near: np.r_[1e4 * apart(q), q - near], near).x for near in values])


def lagrange(file: Path, tree: Any, call: Any, q: Any, u: Any) -> dict[str, float]:
    """Of forces by velocity, the largest difference to d/dt (M u) - d/dq (u M u / 2) over the largest of them.

    M is the mass matrix here; its own largest difference to OpenSim's, as forces without velocity, is beside it.
    """
    import casadi
    import numpy as np

    from geocontact.dynamics.inverse_dynamics import generalised_forces
    from tests import opensim_oracle

    whole = generalised_forces(tree)
    mass = casadi.jacobian(whole, tree.a)
    momentum = mass @ tree.u
    wanted = casadi.jtimes(momentum, tree.q, tree.u) - casadi.gradient(0.5 * casadi.dot(tree.u, momentum), tree.q)
    still = casadi.substitute(whole, tree.a, 0 * tree.a)
    own = still - casadi.substitute(still, tree.u, 0 * tree.u)
    both = casadi.Function("both", [tree.q, tree.u], [wanted, own])
    truth, ours = (np.array(each).T for each in both.map(len(q))(q.T, u.T))
    none = 0.0 * u
    theirs, rest = (call(opensim_oracle.inverse_dynamics, file, tree.names, q, each, none) for each in (u, none))
    forced = call(opensim_oracle.inverse_dynamics, file, tree.names, q, none, u) - rest
    masses = casadi.Function("masses", [tree.q, tree.u], [momentum]).map(len(q))
    size = np.abs(truth).max()
    return {
        "ours": float(np.abs(ours - truth).max() / size),
        "opensim": float(np.abs(theirs - rest - truth).max() / size),
        "mass_matrices": float(np.abs(np.array(masses(q.T, u.T)).T - forced).max() / np.abs(forced).max()),
    }

"""Generalised forces along a recorded motion: rates by a quintic spline, measured loads at the bodies they act on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.tree import Tree

SMOOTH = 5
"""Degree of the spline: accelerations are smooth."""


def forces_along(
    tree: Tree,
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    wanted: Float[np.ndarray, " w"],
    loads: Mapping[str, Wrench],
) -> Float[np.ndarray, "w n"]:
    """What acts along each coordinate beside gravity and the loads [N m, N], at the times that are wanted.

    Parameters
    ----------
    time
        [s], `SMOOTH` + 1 frames at least.
    values
        Coordinates in the tree's order [rad, m], filtered as they are to be.
    wanted
        Times [s] within those of the values.
    loads
        On a body by its name, one wrench per wanted time, in the ground's frame.
    """
    from casadi import SX, Function, vertcat

    unknown = set(loads) - set(tree.bodies)
    if unknown:
        raise ValueError(f"there is no body {min(unknown)}; bodies are {', '.join(tree.bodies)}")
    acting = {name: (SX.sym("force", 3), SX.sym("moment", 3)) for name in loads}
    given = vertcat(*(each for pair in acting.values() for each in pair))
    run = Function("forces", [tree.q, tree.u, tree.a, given], [generalised_forces(tree, acting)])
    curve = make_interp_spline(time, values, k=SMOOTH)
    about = [wrench.moved_to(np.zeros(3)) for wrench in loads.values()]
    known = np.hstack([np.zeros((len(wanted), 0)), *(part for each in about for part in (each.force, each.moment))])
    found = run.map(len(wanted))(curve(wanted).T, curve(wanted, 1).T, curve(wanted, 2).T, known.T)
    return np.array(found).T

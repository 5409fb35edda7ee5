"""Generalised forces along a recorded motion: rates by a quintic spline, measured loads at the bodies they act on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline

from geocontact.data.multibody.passive_forces import PassiveForce
from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_dynamics import Wrenches, generalised_forces
from geocontact.dynamics.passive_loads import passive_loads
from geocontact.dynamics.tree import Tree

SMOOTH = 5
"""Degree of the spline: accelerations are smooth."""


def forces_along(
    tree: Tree,
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    wanted: Float[np.ndarray, " w"],
    loads: Mapping[str, Wrench],
    passive: Sequence[PassiveForce] = (),
) -> Float[np.ndarray, "w n"]:
    """What acts along each coordinate beside gravity, loads and passive forces [N m, N], at the times that are wanted.

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
    passive
        Forces of the model itself.
    """
    from casadi import SX, Function, vertcat

    unknown = set(loads) - set(tree.bodies)
    if unknown:
        raise ValueError(f"there is no body {min(unknown)}; bodies are {', '.join(tree.bodies)}")
    acting = {name: (SX.sym("force", 3), SX.sym("moment", 3)) for name in loads}
    given = vertcat(*(each for pair in acting.values() for each in pair))
    along, on = passive_loads(tree, passive)
    needed = generalised_forces(tree, _summed(acting, on)) - along
    run = Function("forces", [tree.q, tree.u, tree.a, given], [needed])
    curve = make_interp_spline(time, values, k=SMOOTH)
    about = [wrench.moved_to(np.zeros(3)) for wrench in loads.values()]
    known = np.hstack([np.zeros((len(wanted), 0)), *(part for each in about for part in (each.force, each.moment))])
    found = run.map(len(wanted))(curve(wanted).T, curve(wanted, 1).T, curve(wanted, 2).T, known.T)
    return np.array(found).T


def _summed(one: Wrenches, other: Wrenches) -> Wrenches:
    found = dict(one)
    for name, (force, moment) in other.items():
        known = found.get(name, (0.0, 0.0))
        found[name] = (known[0] + force, known[1] + moment)
    return found

"""Generalised forces that a motion needs: Newton and Euler for each body, passive forces, and rates of a recorded
motion.

Luh, Walker & Paul (1980), On-line computational scheme for mechanical manipulators; Featherstone (2008), Rigid Body
Dynamics Algorithms, ch. 5. Everything is in the ground's frame.

The laws are those of OpenSim's classes of the same purpose (OpenSim 4.6 API: CoordinateLimitForce,
SpringGeneralizedForce, BushingForce).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.model import GROUND, CoordinateLimit, CoordinateSpring, FrameBushing, PassiveForce
from geocontact.data.wrench import Wrench
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree

if TYPE_CHECKING:
    from casadi import SX


def passive_loads(tree: Tree, forces: Sequence[PassiveForce]) -> tuple[SX, Wrenches]:
    """Forces along the coordinates [N m, N], (n, 1), and wrenches on bodies [N, N m], for `tree.q` and `tree.u`."""
    from casadi import SX

    along = SX(len(tree.names), 1)
    on: dict[str, tuple[SX, SX]] = {}
    for force in forces:
        if isinstance(force, FrameBushing):
            pull, moment = _bushing(tree, force)
            for body, sign in zip(force.bodies, (-1.0, 1.0), strict=True):
                known = on.get(body, (SX(3, 1), SX(3, 1)))
                on[body] = (known[0] + sign * pull, known[1] + sign * moment)
        else:
            k = tree.names.index(force.coordinate)
            q, u = tree.q[k], tree.u[k]
            along[k] += _limit(force, q, u) if isinstance(force, CoordinateLimit) else _spring(force, q, u)
    return along, on


def _spring(force: CoordinateSpring, q: SX, u: SX) -> SX:
    return -force.stiffness * (q - force.rest) - force.viscosity * u


def _limit(force: CoordinateLimit, q: SX, u: SX) -> SX:
    """-K(d) d - c s(d) u beyond each limit; s rises from 0 to 1 over the transition and K = s times the stiffness."""
    above = _step(q - force.upper, force.transition)
    below = _step(force.lower - q, force.transition)
    springs = force.lower_stiffness * below * (force.lower - q) - force.upper_stiffness * above * (q - force.upper)
    return springs - force.damping * (above + below) * u


def _step(beyond: SX, width: float) -> SX:
    """10 x³ - 15 x⁴ + 6 x⁵ of x = beyond / width between 0 and 1; a step at 0 without a width."""
    from casadi import fmax, fmin

    if width == 0.0:
        return beyond > 0.0
    x = fmin(fmax(beyond / width, 0.0), 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


def _bushing(tree: Tree, force: FrameBushing) -> tuple[SX, SX]:
    """Force on the second body and its moment about the ground's origin; the first body has the opposite.

    Forces act along the Cardan angles θ and the translation: f = -(k θ + c dθ/dt). With the angular velocity of the
    second frame in the first ω = E dθ/dt the moment of equal power is E⁻ᵀ f.
    """
    from casadi import asin, atan2, cos, cross, diag, horzcat, mtimes, sin, solve, vertcat

    first, second = (tree.bodies[body].carried(pose) for body, pose in zip(force.bodies, force.frames, strict=True))
    back = first.rotation.T
    turn = mtimes(back, second.rotation)
    x, y, z = atan2(-turn[1, 2], turn[2, 2]), asin(turn[0, 2]), atan2(-turn[0, 1], turn[0, 0])
    about_y, about_z = vertcat(0.0, cos(x), sin(x)), vertcat(sin(y), -sin(x) * cos(y), cos(x) * cos(y))
    rates = horzcat(vertcat(1.0, 0.0, 0.0), about_y, about_z)
    spin = mtimes(back, second.spin - first.spin)
    apart = second.place - first.place
    drift = mtimes(back, second.speed - first.speed - cross(first.spin, apart))
    bent, shifted = vertcat(x, y, z), mtimes(back, apart)
    stiff, damped = (diag(constant(each)) for each in (force.stiffness, force.damping))
    f = -mtimes(stiff, vertcat(bent, shifted)) - mtimes(damped, vertcat(solve(rates, spin), drift))
    pull = mtimes(first.rotation, f[3:])
    return pull, mtimes(first.rotation, solve(rates.T, f[:3])) + cross(second.place, pull)


Wrenches = Mapping[str, "tuple[SX, SX]"]
"""By body: force [N] and moment about the ground's origin [N m], in the ground's frame."""


def generalised_forces(tree: Tree, loads: Wrenches | None = None) -> SX:
    """What acts along each coordinate, beside gravity and the loads [N m, N], for `tree.q`, `tree.u` and `tree.a`."""
    from casadi import cross, mtimes, vertcat

    across = wrenches_across(tree, loads)
    parts: list[SX] = []
    for joint, axis in zip(tree.model.joints, tree.axes, strict=True):
        force, moment = across[joint.child]
        about = moment - cross(axis.place, force)
        parts.append(mtimes(axis.spin.T, about) + mtimes(axis.speed.T, force))
    return vertcat(*parts)


def wrenches_across(tree: Tree, loads: Wrenches | None = None) -> Wrenches:
    """What acts on each body across the joint to its parent, bones and muscles together; by the body's name."""
    needed = {body.name: _needed(tree, body.name) for body in tree.model.bodies}
    for name, (force, moment) in (loads or {}).items():
        if name != GROUND:
            needed[name] = (needed[name][0] - force, needed[name][1] - moment)
    for joint in reversed(tree.model.joints):
        force, moment = needed[joint.child]
        if joint.parent != GROUND:
            needed[joint.parent] = (needed[joint.parent][0] + force, needed[joint.parent][1] + moment)
    return needed


def _needed(tree: Tree, name: str) -> tuple[SX, SX]:
    """Force that accelerates a body against gravity, and its moment about the ground's origin with that of its spin."""
    from casadi import cross, mtimes

    body = next(each for each in tree.model.bodies if each.name == name)
    frame = tree.bodies[name]
    arm = mtimes(frame.rotation, tree.centres.get(name, constant(body.centre)))
    gravity = constant(tree.model.gravity) if tree.gravity is None else tree.gravity
    fast = frame.speed_rate + cross(frame.spin_rate, arm) + cross(frame.spin, cross(frame.spin, arm))
    force = tree.masses.get(name, body.mass) * (fast - gravity)
    inertia = mtimes(frame.rotation, mtimes(tree.inertias.get(name, constant(body.inertia)), frame.rotation.T))
    spun = mtimes(inertia, frame.spin_rate) + cross(frame.spin, mtimes(inertia, frame.spin))
    return force, spun + cross(frame.place + arm, force)


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

    def needed(acting: Wrenches) -> SX:
        along, on = passive_loads(tree, passive)
        return generalised_forces(tree, _summed(acting, on)) - along

    return _over_time(tree, time, values, wanted, loads, needed)


def force_across(
    tree: Tree,
    body: str,
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    wanted: Float[np.ndarray, " w"],
    loads: Mapping[str, Wrench],
) -> tuple[Float[np.ndarray, "w 3"], Float[np.ndarray, "w 3 3"]]:
    """Force on a body across the joint to its parent [N], in the ground's frame, and the body's rotation.

    Bones, ligaments and muscles have it together; passive forces of the model are among them. Else as `forces_along`.
    """
    from casadi import reshape, vertcat

    def needed(acting: Wrenches) -> SX:
        return vertcat(wrenches_across(tree, acting)[body][0], reshape(tree.bodies[body].rotation, 9, 1))

    found = _over_time(tree, time, values, wanted, loads, needed)
    return found[:, :3], np.ascontiguousarray(found[:, 3:].reshape(-1, 3, 3).swapaxes(1, 2))


def _over_time(
    tree: Tree,
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    wanted: Float[np.ndarray, " w"],
    loads: Mapping[str, Wrench],
    needed: Callable[[Wrenches], SX],
) -> Float[np.ndarray, "w k"]:
    """A column of expressions of the state and of what acts on bodies, at the times that are wanted."""
    from casadi import SX, Function, vertcat
    from scipy.interpolate import make_interp_spline

    unknown = set(loads) - set(tree.bodies)
    if unknown:
        raise ValueError(f"there is no body {min(unknown)}; bodies are {', '.join(tree.bodies)}")
    acting = {name: (SX.sym("force", 3), SX.sym("moment", 3)) for name in loads}
    given = vertcat(*(each for pair in acting.values() for each in pair))
    run = Function("forces", [tree.q, tree.u, tree.a, given], [needed(acting)])
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

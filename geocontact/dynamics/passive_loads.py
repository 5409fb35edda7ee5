"""What passive forces of a model do, in symbols: along coordinates, and on bodies as wrenches about the origin.

The laws are those of OpenSim's classes of the same purpose (OpenSim 4.6 API: CoordinateLimitForce,
SpringGeneralizedForce, BushingForce).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from geocontact.data.multibody.passive_forces import CoordinateLimit, CoordinateSpring, FrameBushing, PassiveForce
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree

if TYPE_CHECKING:
    from casadi import SX

    from geocontact.dynamics.inverse_dynamics import Wrenches


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

"""Law of a strapped-on interface: a spring that pulls and pushes, and every term that may stand beside it.

From the outside in: the attachment may slip; what is left is taken up by play first; the spring carries the rest, with
its stiffening and asymmetry, and a Maxwell branch follows the spring; the dampers, the base's and a further one, follow
the rate beyond the play; stops and the strap's tension see the deflection after slip, dry friction the displacement
itself; of the sum, a contact that may open passes on what pushes. Terms that are absent have neutral numbers and cost
next to nothing, and the order in which they were added does not matter. At a joint the deflection is an angle and the
force a moment: N m and rad in the place of N and m throughout.

The law remembers `MEMORY` numbers per deflection: it reads those of the last accepted sample and writes those of this
one, so it serves along a recorded motion, in an implicit solve and inside an integrator alike.

>>> import geocontact as gc
>>> gc.chain.INTERFACE_LAW.free("dead_zone.width"), gc.chain.INTERFACE_LAW.neutral["relaxation.tau"]
(True, 1.0)
>>> gc.chain.INTERFACE_LAW.having({"k": "stiffness"}).free("k")
False
"""

from __future__ import annotations

import math

from jaxtyping import Float
from numpy import ndarray

from geocontact.chain.links import LawParameters
from geocontact.chain.terms import (
    beyond_play,
    branch_force,
    direction_factor,
    friction_at_rate,
    friction_state,
    power_damping,
    slipped,
    stiffening_factor,
    stop_force,
    strap_tension,
    transmitted,
)
from geocontact.geometry.kernels.compile import kernel

INTERFACE_LAW = LawParameters(
    {
        "k": 0.0,
        "slip.mobility": 0.0,
        "slip.limit": 1.0,
        "dead_zone.width": 0.0,
        "dead_zone.share": 0.5,
        "stiffening.gain": 0.0,
        "stiffening.exponent": 1.0,
        "stiffening.reference": 1.0,
        "end_stop.upper.stiffness": 0.0,
        "end_stop.upper.limit": 0.0,
        "end_stop.lower.stiffness": 0.0,
        "end_stop.lower.limit": 0.0,
        "relaxation.ratio": 0.0,
        "relaxation.tau": 1.0,
        "damping.b": 0.0,
        "damping.exponent": 1.0,
        "damping.reference": 1.0,
        "dry_friction.stroke.limit": 0.0,
        "dry_friction.stroke.reach": 1.0,
        "preload.tension": 0.0,
        "preload.slackening": 0.0,
        "dry_friction.rate.limit": 0.0,
        "dry_friction.rate.turning": 1.0,
        "asymmetry.excess": 0.0,
        "asymmetry.turning": 1.0,
        "end_stop.power": 1.0,
        "end_stop.reference": 1.0,
        "b": 0.0,
        "contact_loss.opening": -math.inf,
        "contact_loss.rounding": 0.0,
        "contact_loss.side": 1.0,
    }
)
"""Numbers of the law in the order in which the kernel reads them, each at the value that means nothing."""

MEMORY = 5
DEFLECTION, SLIP, FRICTION, BRANCH, ELASTIC = range(MEMORY)


@kernel
def spring_force(taut: float, speed: float, n: Float[ndarray, " slots"]) -> float:
    """Force of the spring beyond the play, stiffer with deflection and while it is loaded."""
    elastic = n[0] * taut
    if n[5] != 0.0:
        elastic *= stiffening_factor(taut, n[5], n[6], n[7])
    if n[23] != 0.0:
        elastic *= direction_factor(speed if taut >= 0.0 else -speed, n[23], n[24])
    return float(elastic)


@kernel
def dashpots(speed: float, n: Float[ndarray, " slots"]) -> float:
    """Force against the rate, the base's linear one and a further one."""
    force = n[27] * speed
    if n[14] != 0.0:
        force += power_damping(speed, n[14], n[15], n[16])
    return float(force)


@kernel
def beside(attached: float, n: Float[ndarray, " slots"]) -> float:
    """Force of stops and strap."""
    force = 0.0
    if n[8] != 0.0:
        force += stop_force(attached, n[8], n[9], 1.0, n[25], n[26])
    if n[10] != 0.0:
        force += stop_force(attached, n[10], n[11], -1.0, n[25], n[26])
    if n[19] != 0.0:
        force += strap_tension(attached, n[19], n[20])
    return force


@kernel
def interface_force(
    u: float,
    rate: float,
    h: float,
    n: Float[ndarray, " slots"],
    old: Float[ndarray, " memory"],
    new: Float[ndarray, " memory"],
) -> float:
    """Force at deflection `u` [m] and `rate` [m/s], `h` seconds after the sample that `old` remembers [N].

    `h` = 0 at the first sample: everything is relaxed, nothing has slipped, friction is unloaded.
    """
    slip = old[SLIP]
    if n[1] > 0.0:
        slip = slipped(slip, old[DEFLECTION], u, h, n[0], n[1], n[2])
    attached = u - slip
    speed = rate - (slip - old[SLIP]) / h if h > 0.0 else rate
    taut = beyond_play(attached, n[3], n[4])
    if n[3] > 0.0 and taut == 0.0:
        speed = 0.0
    elastic = spring_force(taut, speed, n)
    force = elastic + dashpots(speed, n) + beside(attached, n)
    branch = 0.0
    if n[12] != 0.0:
        branch = branch_force(old[BRANCH], elastic - old[ELASTIC], h, n[12], n[13])
        force += branch
    friction = 0.0
    if n[17] != 0.0:
        friction = friction_state(old[FRICTION], u - old[DEFLECTION], n[18]) if h > 0.0 else 0.0
        force += n[17] * friction
    if n[21] != 0.0:
        force += n[21] * friction_at_rate(rate, n[22])
    if n[28] != -math.inf:
        force = transmitted(force, n[28], n[29], n[30])
    new[DEFLECTION] = u
    new[SLIP] = slip
    new[FRICTION] = friction
    new[BRANCH] = branch
    new[ELASTIC] = elastic
    return float(force)

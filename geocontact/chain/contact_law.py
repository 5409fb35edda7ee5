"""Law of a sphere on the ground: it pushes, never pulls, and every term may stand beside it that applies to it.

Elastic force and damping of loading are those of `contact.sphere_foot`; stiffening and the direction of motion change
the stiffness, the further damper acts in both directions, a Maxwell branch follows the elastic force, and the sum is
never negative.

>>> import geocontact as gc
>>> list(gc.chain.CONTACT_LAW.neutral)[:5]
['n', 'delta_full', 'mu_s', 'mu_k', 'v_th']
>>> gc.chain.CONTACT_LAW.free("damping.b"), gc.chain.CONTACT_LAW.free("dead_zone.width")
(True, False)
"""

from __future__ import annotations

import math

from jaxtyping import Float
from numpy import ndarray

from geocontact.chain.links import LawParameters
from geocontact.chain.terms import branch_force, direction_factor, stiffening_factor
from geocontact.contact import sphere_foot
from geocontact.geometry.kernels.compile import kernel

CONTACT_LAW = LawParameters(
    {
        "n": 1.0,
        "delta_full": 1.0,
        "mu_s": 0.0,
        "mu_k": 0.0,
        "v_th": 1.0,
        "stiffening.gain": 0.0,
        "stiffening.exponent": 1.0,
        "stiffening.reference": 1.0,
        "asymmetry.excess": 0.0,
        "asymmetry.turning": 1.0,
        "damping.b": 0.0,
        "damping.exponent": 0.0,
        "damping.reference": 1.0,
        "relaxation.ratio": 0.0,
        "relaxation.tau": 1.0,
        "damping.power": 1.0,
        "damping.rate": 1.0,
    }
)
"""Numbers of the law in the order in which the kernel reads them; k and b come with each sphere."""

normal_force = kernel(sphere_foot.normal_force)
friction_coefficient = kernel(sphere_foot.friction_coefficient)


@kernel
def contact_force(
    depth: float,
    rate: float,
    h: float,
    k: float,
    b: float,
    n: Float[ndarray, " slots"],
    branch: float,
    elastic: float,
) -> tuple[float, float, float]:
    """Normal force at `depth` [m] and `rate` [m/s], and what is to be remembered of it: branch and elastic force [N].

    `branch` and `elastic` are those of the last accepted sample, `h` seconds ago; `h` = 0 at the first sample, where
    everything is relaxed. Off the ground the branch goes on relaxing.
    """
    inside = depth > 0.0
    if not inside and n[13] == 0.0:
        return 0.0, 0.0, 0.0
    force = now = 0.0
    if inside:
        if n[5] != 0.0:
            k *= stiffening_factor(depth, n[5], n[6], n[7])
        if n[8] != 0.0:
            k *= direction_factor(rate, n[8], n[9])
        force = normal_force(depth, rate, k, n[0], b, n[1])
    if n[13] != 0.0:
        now = normal_force(depth, 0.0, k, n[0], 0.0, n[1]) if inside else 0.0
        branch = branch_force(branch, now - elastic, h, n[13], n[14])
        force += branch
    if not inside:
        return 0.0, branch, now
    if n[10] != 0.0:
        onset = min(depth / n[1], 1.0)
        drag = n[10] * rate * onset * onset * (3.0 - 2.0 * onset) * math.pow(depth / n[12], n[11])
        if n[15] != 1.0 and rate != 0.0:
            drag *= math.pow(abs(rate) / n[16], n[15] - 1.0)
        force += drag
    return max(force, 0.0), branch, now

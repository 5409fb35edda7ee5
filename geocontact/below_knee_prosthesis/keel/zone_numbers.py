"""Stiffness and damping of each zone from one stance: the keel is solved and both are fitted to its depths, in turn.

While depths and rates are held the vertical load is linear in both, so that each turn is a non-negative least-squares
problem with one minimum, and no start is searched for. It needs a level ground (friction has no vertical part there).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import nnls
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole, force_bases
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw

SHARE, FLOOR, MOST = 0.7, 1e-3, 100
"""Of the way to the linear fit that a turn goes (of the logarithms), least factor of a turn, and turns."""
SMALL = 1e-4
"""Change of the logarithms that ends the search."""


@dataclass(frozen=True)
class ZoneNumbers:
    """What was found.

    Parameters
    ----------
    law
        With stiffness [N/m^n] and damping [N s/m] of the zones.
    stiffness, damping
        By zone, of a sphere.
    motion
        Of the keel with them.
    residual
        Root mean square of the load that is left [N], turn by turn.
    converged
        Whether the numbers stopped changing. A zone that is never loaded keeps those it had.
    """

    law: SoleLaw
    stiffness: dict[str, float]
    damping: dict[str, float]
    motion: KeelMotion
    residual: Float[np.ndarray, " turns"]
    converged: bool


def zone_numbers(
    one: QuasiStaticKeel,
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    time: Float[np.ndarray, " t"],
    ground: HalfSpace,
    load: Float[np.ndarray, " t"],
) -> ZoneNumbers:
    """From the numbers that the keel's law has, which must be positive, to those that carry a load [N].

    Parameters
    ----------
    load
        Normal to the ground, in each frame.
    """
    sole, law, count = one.sole, one.law, len(one.sole.spheres.zones)
    stiffness, damping = (_by_zone(sole, each) for each in (law.stiffness, law.damping))
    residual: list[float] = []
    upwards, converged = np.asarray(ground.normal, float) / np.linalg.norm(ground.normal), False
    while True:
        law = replace(law, stiffness=_by_sphere(sole, stiffness), damping=_by_sphere(sole, damping))
        motion = replace(one, law=law).solve(poses, ground, rate=rate, time=time)
        off = load - motion.force @ upwards
        residual.append(float(np.sqrt(np.mean(off**2))))
        if converged or len(residual) > MOST:
            break
        bases = np.hstack(force_bases(motion.loads.depth, motion.rate, sole, law.exponent, law.full_depth))
        size = np.linalg.norm(bases, axis=0)
        loaded = size > 0.0
        factor = np.ones(2 * count)
        now = np.concatenate([stiffness, damping])
        fitted = nnls(bases[:, loaded] / size[loaded], load)[0] / size[loaded]
        factor[loaded] = np.maximum(fitted / now[loaded], FLOOR) ** SHARE
        stiffness, damping = stiffness * factor[:count], damping * factor[count:]
        converged = bool(np.abs(np.log(factor)).max() < SMALL)
    names = list(sole.spheres.zones)
    found = [dict(zip(names, map(float, each), strict=True)) for each in (stiffness, damping)]
    return ZoneNumbers(law, found[0], found[1], motion, np.array(residual), converged)


def _by_zone(sole: KeelSole, values: Float[np.ndarray, " n"]) -> Float[np.ndarray, " zones"]:
    return np.array([values[chosen][0] for chosen in sole.spheres.zones.values()])


def _by_sphere(sole: KeelSole, values: Float[np.ndarray, " zones"]) -> Float[np.ndarray, " n"]:
    found = np.empty(len(sole.spheres))
    for chosen, value in zip(sole.spheres.zones.values(), values, strict=True):
        found[chosen] = value
    return found

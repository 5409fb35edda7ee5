"""Stiffness and damping of the zones at held depths: a bounded linear least-squares problem.

Where depths, their rates and the directions of sliding are held, normal forces are linear in stiffness and damping; so
are, at held friction, the forces along the ground and the moment of the normal forces about the measured centre.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.optimize import lsq_linear

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.simulate import share_of_foot
from geocontact.contact.sphere_foot import normal_force
from geocontact.loads.sphere_set import SoleLaw


def linear_rows(
    stance: RecordedStance, keel: QuasiStaticKeel, motion: KeelMotion, noise: Float[np.ndarray, "t c"]
) -> tuple[Float[np.ndarray, "rows k"], Float[np.ndarray, " rows"]]:
    """Matrix on stiffness and damping of the zones, and what it should give, both over the noise.

    The centre's rows are the moment about the measured centre over the measured force; they leave out frames without.
    """
    law: SoleLaw = keel.law
    zones = np.stack(list(keel.sole.spheres.zones.values()), axis=1).astype(float)
    depth, rate = motion.loads.depth, motion.rate
    parts: list[np.ndarray] = [np.asarray(normal_force(depth, rate, *each)) for each in _units(law)]
    pressing = motion.loads.pressing[..., None]
    per_pressing = np.divide(motion.loads.force, pressing, out=np.zeros_like(motion.loads.force), where=pressing > 0.0)
    along = np.stack(
        [share_of_foot(stance.poses, keel.keel.length, point) for point in motion.loads.point.swapaxes(0, 1)], axis=1
    )
    known = np.isfinite(stance.centre)
    arm = np.nan_to_num(along[known] - stance.centre[known, None]) / stance.force[known, 1, None]
    blocks = [
        np.hstack([(part * per_pressing[..., axis]) @ zones for part in parts]) / noise[:, axis, None]
        for axis in range(3)
    ]
    blocks.append(np.hstack([(part[known] * arm) @ zones for part in parts]) / noise[known, 3, None])
    target = [stance.force[:, axis] / noise[:, axis] for axis in range(3)]
    return np.vstack(blocks), np.concatenate([*target, np.zeros(int(known.sum()))])


def bounded_fit(
    matrix: Float[np.ndarray, "rows k"],
    target: Float[np.ndarray, " rows"],
    now: Float[np.ndarray, " k"],
    sd: Float[np.ndarray, " k"],
    usual: Float[np.ndarray, " k"],
    reach: Float[np.ndarray, " k"],
) -> Float[np.ndarray, " k"]:
    """Numbers within `usual` e^±reach that fit best, each held to its present value by `sd` of itself.

    What no row tells keeps its present value.
    """
    scaled = np.vstack([matrix * now, np.diag(1.0 / sd)])
    bounds = (usual * np.exp(-reach) / now, usual * np.exp(reach) / now)
    wanted = np.concatenate([target, 1.0 / sd])
    return np.asarray(now * lsq_linear(scaled, wanted, bounds).x)


def _units(law: SoleLaw) -> tuple[tuple[float, float, float, float], tuple[float, float, float, float]]:
    """Stiffness, exponent, damping and depth of a unit of stiffness, and of damping."""
    return (1.0, law.exponent, 0.0, law.full_depth), (0.0, law.exponent, 1.0, law.full_depth)

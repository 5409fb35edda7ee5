"""Whether markers and plate run on one clock: when the sole is on the floor beside when the plate is loaded."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import longest_stance
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SphereSet

FLOOR = HalfSpace()


def lowest_sphere(poses: RigidTransform, spheres: SphereSet, ground: Ground = FLOOR) -> Float[np.ndarray, " t"]:
    """Height of the lowest point of a sole that does not bend [m]; negative where markers say that it is pressed.

    `poses` are X_GK of the spheres' frame in the ground's.
    """
    pairs = zip(spheres.centre, spheres.radius, strict=True)
    low = [ground.proximity(poses.apply(centre)).distance - radius for centre, radius in pairs]
    return np.asarray(np.min(low, axis=0))


def clock_offset(
    time: Float[np.ndarray, " t"],
    height: Float[np.ndarray, " t"],
    plate_time: Float[np.ndarray, " p"],
    load: Float[np.ndarray, " p"],
) -> float:
    """By how much the plate is later than the markers [s], at least: the smaller one of touch-down's and toe-off's.

    0 where they differ in sign, as by a height that is off, or where either is not seen. A foot that hovers close to
    the floor before it lands makes one of them uncertain, hardly both in the same sense.

    Parameters
    ----------
    height
        `lowest_sphere` at the markers' times.
    load
        Vertical force on the plate [N].
    """
    seen = longest_stance(plate_time, load)
    down = np.flatnonzero(height < 0.0)
    if seen is None or not len(down):
        return 0.0
    first, last = down[0], down[-1]
    if first == 0 or last == len(time) - 1:
        early = np.nan if first == 0 else seen[0] - time[first]
        late = np.nan if last == len(time) - 1 else seen[1] - time[last]
        return float(np.nan_to_num(early if np.isnan(late) else late))
    early, late = seen[0] - float(time[first]), seen[1] - float(time[last])
    return 0.0 if early * late <= 0.0 else float(np.sign(early) * min(abs(early), abs(late)))

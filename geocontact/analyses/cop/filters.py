"""Motion and forces without what lies above a cut-off, as gait laboratories smooth them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.identify.signals.even_times import UNEVEN
from geocontact.identify.signals.zero_lag import zero_lag
from geocontact.io.mocap.force_plates import ForcePlate


def smoothed_motion(motion: Motion, cutoff: float | None, file: Path) -> Motion:
    """The motion through the filter; 0 Hz and None leave it as it is.

    Entries of the pose matrices are filtered, and the nearest rotation is taken (from the singular value
    decomposition): so it does not matter in which frame of the ground, or of the foot, the motion is given.
    """
    if not cutoff:
        return motion
    matrices = motion.poses.as_matrix().reshape(-1, 4, 4)
    smooth = low_passed(motion.time, matrices[:, :3].reshape(-1, 12), cutoff, file, "`motion_cutoff`").reshape(-1, 3, 4)
    left, _, right = np.linalg.svd(smooth[:, :, :3])
    poses = RigidTransform.from_components(smooth[:, :, 3], Rotation.from_matrix(left @ right))
    return replace(motion, poses=poses)


def smoothed_plate(plate: ForcePlate, cutoff: float | None, file: Path) -> ForcePlate:
    """Force and moment of a plate through the filter, at its own times."""
    if not cutoff:
        return plate
    w = plate.wrench
    force, moment = (low_passed(plate.time, each, cutoff, file, "`force_cutoff`") for each in (w.force, w.moment))
    return replace(plate, wrench=replace(w, force=force, moment=moment))


def low_passed(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t k"], cutoff: float, file: Path, option: str
) -> Float[np.ndarray, "t k"]:
    """Columns at even times through `zero_lag`; InputError where times are not even, a value is missing, or too few."""
    remedy = f"resample the recording, or leave {option} out"
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    if step == 0.0 or np.abs(np.diff(time) - step).max() > 2.0 * UNEVEN * step:
        raise InputError(file, "time", "is not evenly spaced, as a filter needs it", remedy)
    if not np.isfinite(values).all():
        raise InputError(file, "", "has gaps that a filter cannot cross", remedy)
    try:
        return zero_lag(values, step, cutoff)
    except ValueError as error:
        raise InputError(file, "", str(error), f"give another {option}") from error

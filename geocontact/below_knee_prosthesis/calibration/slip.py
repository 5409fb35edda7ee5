"""What the foot must slip besides its recorded speed for the ground to push along the floor as the plate says.

Below its threshold speed, some millimetres a second, friction is proportional to the speed of slipping: far less than
markers tell. So the recorded speed is taken as known up to its error, and in every frame the correction is sought with
which the model's force along the floor is the plate's. It counts as a residual, in units of that error. Friction is
told by it only where a foot slips in earnest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel

ALONG = (0, 2)
"""Axes of the floor."""
PRESSED, MOST = 20.0, 4.0
"""N, below which nothing is corrected, and most of a correction in units of the speed's error."""


def slipping(
    stance: RecordedStance, keel: QuasiStaticKeel, slip: Float[np.ndarray, "t 2"], turns: int
) -> tuple[KeelMotion, Float[np.ndarray, "t 2"]]:
    """Motion of the keel and the correction [m/s] after some turns from another correction.

    ArithmeticError where the keel finds no equilibrium.
    """
    motion = with_slip(stance, slip).solved(keel)
    for _ in range(turns):
        pressing = motion.loads.pressing
        whole = pressing.sum(axis=1)
        slope = (pressing @ np.broadcast_to(keel.law.kinetic, pressing.shape[1])) / keel.law.threshold_speed
        lacking = (stance.force - motion.force)[:, ALONG]
        step = np.where((whole > PRESSED)[:, None], -lacking / np.maximum(slope, 1e-9)[:, None], 0.0)
        most = MOST * stance.errors.speed
        slip = np.clip(slip + step, -most, most)
        motion = with_slip(stance, slip).solved(keel)
    return motion, slip


def with_slip(stance: RecordedStance, slip: Float[np.ndarray, "t 2"]) -> RecordedStance:
    """The stance with its speed along the floor corrected."""
    rate = stance.rate.copy()
    rate[:, ALONG, 3] += slip
    return replace(stance, rate=rate)

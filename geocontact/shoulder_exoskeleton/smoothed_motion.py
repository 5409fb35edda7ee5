"""An arm's motion at even times, without gaps, after a zero-lag low-pass, as a simulation needs it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.identify.signals.filled import filled_and_smoothed
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion


def smoothed_motion(arm: ArmMotion, cutoff: float | None, longest_gap: float) -> ArmMotion:
    """Points, gravity and elevation alike.

    Parameters
    ----------
    cutoff
        Of the low-pass [Hz]; None: none.
    longest_gap
        That is bridged [s]; ValueError beyond.
    """
    columns = np.hstack([arm.interface, arm.shoulder, arm.gravity_at_frames(), arm.elevation[:, None]])
    time, values = filled_and_smoothed(arm.time, columns, cutoff=cutoff, longest_gap=longest_gap)
    return replace(
        arm,
        time=time,
        interface=values[:, :3],
        shoulder=values[:, 3:6],
        gravity=values[:, 6:9],
        elevation=values[:, 9],
    )

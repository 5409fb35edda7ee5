"""Motion of an upper arm as the exoskeleton sees it: recorded, or at even times after a low-pass.

The device's frame LCS is that of Yao et al. (2024), A novel approach to simulating realistic exoskeleton behavior in
response to human motion, Robotics 13:27, sec. 2.2: origin at the marker Lucy_MC, x to the wearer's left along the
shoulder bar, y backwards, z up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.filters import filled_and_smoothed

Side = Literal["right", "left"]


@dataclass(frozen=True, eq=False)
class ArmMotion:
    """One upper arm in the LCS, frame by frame.

    Parameters
    ----------
    side
        Of the wearer.
    time
        [s], increasing.
    interface
        Centre of the sphere in the cuff [m]: marker humerus_rdn or humerus_ldn; NaN where it was not seen.
    shoulder
        Upper marker of the arm [m]: humerus_rup or humerus_lup; NaN where it was not seen.
    elevation
        Elevation of the human shoulder, 0 hanging down [rad].
    gravity
        [m/s²] in the LCS, one for all frames or one for each: it turns where the trunk does.
    """

    side: Side
    time: Float[np.ndarray, " t"]
    interface: Float[np.ndarray, "t 3"]
    shoulder: Float[np.ndarray, "t 3"]
    elevation: Float[np.ndarray, " t"]
    gravity: Float[np.ndarray, "t 3"] | Float[np.ndarray, " 3"]

    def gravity_at_frames(self) -> Float[np.ndarray, "t 3"]:
        """One row for each frame."""
        return np.broadcast_to(self.gravity, (len(self.time), 3)).copy()


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

"""Motion of an upper arm as the exoskeleton sees it: two points of it in the device's frame.

The device's frame LCS is that of Yao et al. (2024), A novel approach to simulating realistic exoskeleton behavior in
response to human motion, Robotics 13:27, sec. 2.2: origin at the marker Lucy_MC, x to the wearer's left along the
shoulder bar, y backwards, z up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

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

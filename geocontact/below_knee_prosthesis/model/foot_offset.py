"""Where a foot is on its socket, beside where a standing trial has it.

A standing trial places the keel as if the foot had stood flat on the floor. Where it stood out of flat, that place is
wrong by a height and a pitch, which hold for every walk that is read with the same standing trial.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MIDDLE = np.array([0.11, 0.0, 0.0])
"""m; of the keel, about which an error of pitch turns it."""


@dataclass(frozen=True)
class FootOffset:
    """Of the foot on the socket, beside its standing trial; none unless it was found.

    Parameters
    ----------
    height
        By which the middle of the foot is raised, along the keel's upward axis [m].
    pitch
        By which it is turned about that middle, the toes up [rad].
    height_sd, pitch_sd
        Standard deviations of both.
    """

    height: float = 0.0
    pitch: float = 0.0
    height_sd: float = 0.0
    pitch_sd: float = 0.0

    @property
    def given(self) -> bool:
        """Whether there is anything of it."""
        return self != AS_STOOD

    @property
    def words(self) -> str:
        """Height and pitch with their standard deviations."""
        return (
            f"{1e3 * self.height:+.2f} mm (SD {1e3 * self.height_sd:.2f}) and {np.degrees(self.pitch):+.2f} degrees "
            f"(SD {np.degrees(self.pitch_sd):.2f}, toes up)"
        )


AS_STOOD = FootOffset()
"""Nothing beside the standing trial."""

"""What is to be doubted of a simulated arm."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.simulate import FARTHEST, ArmSimulation


def warn_of(found: ArmSimulation, record: Record, trial: str = "") -> None:
    """Warn where the sphere is out of the cuff, far away from it, or a joint is at a stop."""
    which, time = f"{trial}{': ' if trial else ''}{found.motion.side} arm", found.motion.time
    out = found.out_of_cuff
    if out.any():
        far = np.abs(found.told["place"][:, 0])
        lost = "; the device has lost the arm there" if far.max() > FARTHEST else ""
        record.warn(
            f"{which}: the sphere is out of the cuff for {out.mean():.0%} of the time, first at "
            f"{time[out][0]:.2f} s, up to {1e3 * far.max():.0f} mm from its middle{lost}"
        )
    for joint, at in zip(JOINTS, found.at_stop.T, strict=True):
        if at.any():
            record.warn(f"{which}: {joint} is at a stop for {at.mean():.0%} of the time, first at {time[at][0]:.2f} s")

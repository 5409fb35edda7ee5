"""What is said and doubted of a simulated arm: where the sphere is out of the cuff, and joints at their stops."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.frame.collector import judge, reserve
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation


def out_of_cuff_words(*shares: float) -> str:
    """What a sentence says besides where the sphere is out of the cuff for a while; else nothing.

    Parameters
    ----------
    shares
        Of the time, of each simulation that the sentence is about.
    """
    out = [share for share in shares if share > 0.0]
    if not out:
        return ""
    where = "" if len(shares) == 1 else f"in {len(out)} of {len(shares)} simulations, "
    return f"; the sphere is out of the cuff {where}for {'up to ' if where else ''}{share_words(max(out))} of the time"


def out_of_cuff_clause(*found: ArmSimulation) -> str:
    """The same of simulations."""
    return out_of_cuff_words(*(float(each.out_of_cuff.mean()) for each in found))


def share_words(value: float) -> str:
    """In per cent, never 0."""
    return f"{value:.0%}" if value >= 5e-3 else f"{value:.2%}"


def warn_of(found: ArmSimulation) -> None:
    """Warn where the sphere is out of the cuff, or a joint is at a stop."""
    which, time = f"{found.motion.side} arm", found.motion.time
    out = found.out_of_cuff
    share = float(out.mean())
    lost = Doubt(f"{which}: the sphere is out of the cuff for {share_words(share)} of the time", True)
    judge(GoodnessOfFit((lost,) if share >= MUCH else (), (f"{which} in its cuff",)))
    if out.any():
        far = np.abs(found.outputs["place"][:, 0])
        reserve(
            f"{which}: the sphere is out of the cuff for {share_words(float(out.mean()))} of the time, first at "
            f"{time[out][0]:.2f} s, up to {1e3 * far.max():.0f} mm from its middle"
        )
    for joint, at in zip(JOINTS, found.at_stop.T, strict=True):
        if at.any():
            reserve(f"{which}: {joint} is at a stop for {at.mean():.0%} of the time, first at {time[at][0]:.2f} s")

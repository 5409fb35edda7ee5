"""Whether the cuff holds the arm at all: the equations have a tube without ends, the cuff has two.

A sphere beyond an end is still pressed on there, so that what is found has nothing to do with the device.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.device import Device, Wearer

BEYOND = 0.5
"""Of the cuff's radius: a sphere farther than that beyond an end is lost. One that is less far out is told, but not
refused: without support the device hangs on the arm and slides to 20 mm beyond its end on the shipped trial."""
MOST_LOST = 0.25
"""Share of the time for which the sphere may be lost; beyond, nothing that is found is a result. Our choice: a cuff set
for an arm 8 cm too short loses it for 27 % of the shipped trial, one set 5 cm too short or 3 cm too long never."""
RAISED = np.radians(30.0)
"""Elevation below which an arm that was recorded at work comes somewhere, unless its markers are exchanged."""
SHORTEST, LONGEST = 0.20, 0.45
"""Upper arms of grown-up persons [m]."""


class OutOfCuffError(ArithmeticError):
    """The sphere is far out of the cuff for too long.

    Parameters
    ----------
    what
        For how long, when and how far.
    cause
        What is probably wrong, as a question to whoever gave the input.
    """

    def __init__(self, what: str, cause: str) -> None:
        super().__init__(f"{what}; {cause}")
        self.what, self.cause = what, cause


def require_in_cuff(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    along: Float[np.ndarray, " t"],
    hinge: Float[np.ndarray, "t 3"],
    most: float = MOST_LOST,
) -> None:
    """`OutOfCuffError` where the sphere is lost for more than this share of the time.

    Parameters
    ----------
    along
        Place of the sphere along the cuff, from its middle towards the hand [m].
    hinge
        Active joint, in the motion's frame [m].
    """
    end = 0.5 * device["cuff_length"]
    out = np.flatnonzero(np.abs(along) > end + BEYOND * device["cuff_radius"])
    if len(out) <= most * len(along):
        return
    time, far = motion.time[out[[0, -1]]], float(np.abs(along).max())
    what = (
        f"the sphere is far out of the cuff for {len(out) / len(along):.0%} of the time, between {time[0]:.2f} and "
        f"{time[1]:.2f} s, up to {1e3 * (far - end):.0f} mm beyond its end: no result"
    )
    raise OutOfCuffError(what, _cause(motion, device, wearer, along, hinge))


def _cause(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    along: Float[np.ndarray, " t"],
    hinge: Float[np.ndarray, "t 3"],
) -> str:
    """The first that the motion speaks for: exchanged markers, another length, a short cuff, a unit."""
    upper, lower = ("humerus_rup", "humerus_rdn") if motion.side == "right" else ("humerus_lup", "humerus_ldn")
    apart = [float(np.median(np.linalg.norm(each - hinge, axis=1))) for each in (motion.shoulder, motion.interface)]
    if apart[0] > apart[1] and motion.elevation.min() > RAISED:
        return (
            f"are {upper} and {lower} exchanged? the upper one is farther from the device's active joint "
            f"({1e3 * apart[0]:.0f} mm) than the lower one ({1e3 * apart[1]:.0f} mm)"
        )
    low, high = float(along.min()), float(along.max())
    fits = wearer.upper_arm + 0.5 * (low + high) / device["armrest_share"]
    if not SHORTEST <= fits <= LONGEST:
        return "are unit and names of the markers right, `person`, and `device`? no upper arm would fit them"
    if high - low > device["cuff_length"]:
        slides, long = 1e3 * (high - low), 1e3 * device["cuff_length"]
        return f"is `cuff_length` right? the sphere slides over {slides:.0f} mm, the cuff is {long:.0f} mm long"
    return (
        f"is `upper_arm` of `person` right, and its unit? {1e3 * wearer.upper_arm:.0f} mm are set, "
        f"{1e3 * fits:.0f} mm would put the cuff where the sphere is"
    )

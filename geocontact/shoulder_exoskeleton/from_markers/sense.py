"""Whether arms in the device's frame are where arms are."""

from __future__ import annotations

import numpy as np

from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.from_markers.marker_names import MIDDLE

STEEPEST = np.radians(60.0)
"""Inclination of the device's z in the median beyond which the axes of the file are doubted [rad]."""
BEHIND = 0.05
"""How far the shoulders may lie behind Lucy_MC [m] before left and right are taken to be exchanged everywhere."""


def require_sense(source: str, arms: tuple[ArmMotion, ...]) -> None:
    """Upright, arms on their sides, shoulders before the bar."""
    gravity = np.nanmedian(arms[0].gravity_at_frames(), axis=0)
    tilt = float(np.arctan2(np.hypot(gravity[0], gravity[1]), -gravity[2]))
    if tilt > STEEPEST:
        what = f"the device is inclined {np.degrees(tilt):.0f} degrees from upright"
        raise InputError(source, "", what, "is y up in the file? turn it with `axes`; is T10 the lowest marker?")
    places = {arm.side: np.nanmedian(arm.shoulder, axis=0) for arm in arms}
    sides = {"right": -1.0, "left": 1.0}
    wrong = [side for side, place in places.items() if sides[side] * place[0] < 0.0]
    behind = float(np.median([place[1] for place in places.values()]))
    if wrong or behind > BEHIND:
        what = (
            f"the {wrong[0]} shoulder lies on the {_other(wrong[0])} side of {MIDDLE}"
            if wrong
            else f"the shoulders lie {1e3 * behind:.0f} mm behind {MIDDLE}"
        )
        remedy = "left and right are exchanged, in the arms' markers or in Lucy_Mleft; rename with `markers_map`"
        raise InputError(source, "", what, remedy)


def _other(side: Side) -> Side:
    return "left" if side == "right" else "right"

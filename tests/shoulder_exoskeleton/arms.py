"""A synthetic arm that is raised, held and lowered."""

from __future__ import annotations

import numpy as np

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.device import Wearer

GRAVITY = np.array([0.0, 0.0, -9.81])
FITTING = Wearer(upper_arm=0.27)
"""With this one the sphere of `lifted` stays in the cuff."""
SHOULDER = np.array([-0.18, -0.12, -0.02])


def raised(time: np.ndarray, low: float = 0.2, high: float = 2.0) -> np.ndarray:
    """Elevation [rad]: up in 1.5 s, held, down in 1.5 s, smooth to the second derivative."""
    end = time[-1]
    x = np.clip(np.minimum(time - 0.5, end - 0.5 - time) / 1.5, 0.0, 1.0)
    return low + (high - low) * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


def lifted(
    seconds: float = 6.0,
    step: float = 0.01,
    plane: float = 0.5,
    reach: float = 0.19,
    side: Side = "right",
    low: float = 0.2,
) -> ArmMotion:
    """A right arm raised in an upright plane that is `plane` [rad] outwards of the sagittal one, or a left one.

    The shoulder rises by 4 cm with the arm, so that its axis is not the device's.
    """
    time = np.arange(round(seconds / step) + 1) * step
    angle = raised(time, low)
    across = np.array([-np.sin(plane), -np.cos(plane), 0.0])
    along = np.sin(angle)[:, None] * across - np.cos(angle)[:, None] * np.array([0.0, 0.0, 1.0])
    shoulder = SHOULDER + np.outer(0.02 * (1.0 - np.cos(angle)), [0.0, 0.0, 1.0])
    upper, lower = shoulder + 0.03 * along, shoulder + reach * along
    if side == "left":
        upper, lower = (each * np.array([-1.0, 1.0, 1.0]) for each in (upper, lower))
    return ArmMotion(side, time, lower, upper, angle, GRAVITY)

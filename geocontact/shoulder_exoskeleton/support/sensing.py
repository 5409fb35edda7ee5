"""What the controller gets to see: angle and current late, with noise, in steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Sensing:
    """Sensors of the device's arm and of the tool; all invented, the paper tells none of it.

    Parameters
    ----------
    noise
        Standard deviation of the angle [rad].
    step
        Of its quantisation [rad]; 0 for none.
    delay
        Of angle and current [s].
    current_noise
        Standard deviation added to the current [A].
    """

    noise: float = np.radians(0.1)
    step: float = np.radians(0.1)
    delay: float = 0.01
    current_noise: float = 0.1


def sensed(
    time: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    current: Float[np.ndarray, " t"],
    sensing: Sensing,
    rng: np.random.Generator,
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Angle [rad] and current [A] as they arrive at the same times; before the first they are as at the first."""
    late = time - sensing.delay
    angle = np.interp(late, time, elevation) + rng.normal(0.0, sensing.noise, len(time))
    if sensing.step > 0.0:
        angle = sensing.step * np.round(angle / sensing.step)
    return angle, np.interp(late, time, current) + rng.normal(0.0, sensing.current_noise, len(time))

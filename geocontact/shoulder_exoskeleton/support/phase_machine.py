"""State machine of the controller: which work phase it is, from what has been measured so far.

Yao et al. (2024), Robotics 13:27, fig. 7: lifting and lowering are told by elevation and rate of the device's arm,
screwing by the tool's current. The paper's thresholds came from tuning and are not printed; those here are tuned on
synthetic trials. Hysteresis: each phase is left at another threshold than it is entered, and only if the condition has
held for a while. The support moves the arm that it is controlled by: when the tool stops, less support lets the device
sink in its cuff, which must not pass for a lowering, nor its slipping at the end of one for a lift.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel
from geocontact.shoulder_exoskeleton.support.phases import LIFT, LOWER, REST, SCREW

LOW, HIGH, UP, DOWN, STILL, ON, OFF, CONFIRMED, RUNNING, SMOOTHING, SETTLED, TURNED = range(12)
"""Places of the thresholds where they are an array."""


@dataclass(frozen=True)
class Thresholds:
    """When phases change.

    Parameters
    ----------
    low, high
        Elevation below which resting arms may be [rad], and above which they are raised whatever their rate.
    up, down, still
        Rates at which a lift and a lowering begin, and below which lowering may have ended [rad/s].
    on, off
        Current at which the tool runs, and below which it does not any more [A].
    confirmed
        Time for which a condition of elevation and rate must hold [s].
    running
        The same for the current [s].
    smoothing
        Time constant of the controller's low-pass on elevation and rate [s].
    settled
        Time after the tool stops until a lowering may begin [s].
    turned
        Time for which an arm that is lowered must rise to be lifted again [s].
    """

    low: float = 0.40
    high: float = 0.87
    up: float = 0.12
    down: float = 0.23
    still: float = 0.30
    on: float = 2.5
    off: float = 1.5
    confirmed: float = 0.01
    running: float = 0.0
    smoothing: float = 0.03
    settled: float = 0.25
    turned: float = 0.08

    def __post_init__(self) -> None:
        for below, above in (("low", "high"), ("off", "on")):
            if not getattr(self, below) < getattr(self, above):
                raise ValueError(f"threshold {below} must be below {above}, or phases change at every sample")
        if min(self.up, self.down, self.still) <= 0.0:
            raise ValueError("thresholds of rates must be positive")


def detected(
    time: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    current: Float[np.ndarray, " t"],
    thresholds: Thresholds | None = None,
) -> Int[np.ndarray, " t"]:
    """Phase at every sample, from it and those before.

    Parameters
    ----------
    elevation
        Of the device's arm as its sensor gives it [rad].
    current
        Of the tool at the same times [A].
    """
    used = thresholds or Thresholds()
    limits = np.array([getattr(used, each.name) for each in fields(Thresholds)])
    found: Int[np.ndarray, " t"] = _detected(time, elevation, current, limits)
    return found


@kernel
def _detected(
    time: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    current: Float[np.ndarray, " t"],
    limits: Float[np.ndarray, " twelve"],
) -> Int[np.ndarray, " t"]:
    """Through a causal low-pass of first order, from rest before the start; a change waits until it is confirmed."""
    found = np.empty(time.size, np.int64)
    phase, wanted, since, stopped = REST, REST, time[0], -np.inf
    smooth, rate = elevation[0], 0.0
    for k in range(time.size):
        if k:
            step = time[k] - time[k - 1]
            before = smooth
            smooth += step / (limits[SMOOTHING] + step) * (elevation[k] - smooth)
            rate = (smooth - before) / step
        following = _next(phase, smooth, rate, current[k], limits)
        if following == LOWER and time[k] - stopped < limits[SETTLED]:
            following = phase
        if following != wanted:
            wanted, since = following, time[k]
        if wanted != phase and time[k] - since >= limits[_waits(phase, wanted)] - 1e-9:
            if phase == SCREW:
                stopped = time[k]
            phase = wanted
        found[k] = phase
    return found


@kernel
def _waits(phase: int, wanted: int) -> int:
    """Place of the time for which a change must be wanted."""
    if SCREW in (phase, wanted):
        return RUNNING
    return TURNED if phase == LOWER and wanted == LIFT else CONFIRMED


@kernel
def _next(phase: int, elevation: float, rate: float, current: float, limits: Float[np.ndarray, " twelve"]) -> int:
    """Phase that the last sample asks for."""
    if phase == SCREW:
        return SCREW if current >= limits[OFF] else LIFT
    if phase == REST:
        return LIFT if rate > limits[UP] or elevation > limits[HIGH] else REST
    if current > limits[ON]:
        return SCREW
    if elevation < limits[LOW] and abs(rate) < limits[STILL] and (phase == LOWER or rate <= 0.0):
        return REST
    if phase == LIFT:
        return LOWER if rate < -limits[DOWN] else LIFT
    return LIFT if rate > limits[UP] else LOWER

"""State machine of the controller: work phases from what it senses, and how well they are detected.

Yao et al. (2024), Robotics 13:27, fig. 7: lifting and lowering are known by elevation and rate of the device's arm,
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
from geocontact.shoulder_exoskeleton.work_phases import PHASES

REST, LIFT, SCREW, LOWER = (PHASES.index(name) for name in ("rest", "lift", "screw-in", "lower"))
"""Arms that are held up while the tool does not run count as lifted."""
SUPPORTED = (LIFT, SCREW, LOWER)
"""Phases that have a factor of support; at rest there is none."""


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


ONSET = 0.1
"""Share of a movement's peak rate at which it begins and ends; 5 and 10 % are usual for reaching movements."""


@dataclass(frozen=True)
class PhaseCheck:
    """Errors of one detection beside the true phases.

    Parameters
    ----------
    wrong
        Share of the samples in a wrong phase.
    changes, true_changes
        How often the phase changes; more than in truth is chatter.
    latencies
        How late each change is [s]; empty where the order of phases is another one.
    """

    wrong: float
    changes: int
    true_changes: int
    latencies: tuple[float, ...]

    @property
    def chatter(self) -> bool:
        """Whether phases change more often than they do in truth."""
        return self.changes > self.true_changes


def phase_check(
    time: Float[np.ndarray, " t"], detected: Int[np.ndarray, " t"], true: Int[np.ndarray, " t"]
) -> PhaseCheck:
    """Detected beside true phases of the same samples."""
    found, wanted = (np.flatnonzero(np.diff(each)) + 1 for each in (detected, true))
    same = len(found) == len(wanted) and np.array_equal(detected[found], true[wanted])
    late = tuple(float(time[a] - time[b]) for a, b in zip(found, wanted, strict=True)) if same else ()
    return PhaseCheck(float(np.mean(detected != true)), len(found), len(wanted), late)


def phases_by_onset(
    time: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    planned: Int[np.ndarray, " t"],
    onset: float = ONSET,
) -> Int[np.ndarray, " t"]:
    """Phases whose movements begin and end at a share of their peak rate, within the planned ones.

    Parameters
    ----------
    elevation
        Without noise [rad].
    planned
        Phases as a trial was planned, movements from standstill to standstill.
    onset
        That share.
    """
    rate, found = np.gradient(elevation, time), planned.copy()
    first = np.flatnonzero(planned == LIFT)
    if len(first):
        up = first[: int(np.argmax(np.diff(first, append=len(time) + 1) > 1)) + 1]
        begun = up[np.argmax(rate[up] > onset * rate[up].max())]
        found[up[up < begun]] = REST
    down = np.flatnonzero(planned == LOWER)
    if len(down):
        fast = down[rate[down] < onset * rate[down].min()]
        found[down[down < fast[0]]] = LIFT
        found[down[down > fast[-1]]] = REST
    return found

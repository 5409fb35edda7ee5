"""What is known of one arm in one trial, and the case that it makes: exactly, or with the model's own errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.human_arm.elevation_torque import ElevationTorque
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds, detected
from geocontact.shoulder_exoskeleton.support.sensing import Sensing, sensed
from geocontact.shoulder_exoskeleton.support.support_case import Hand, SupportCase


@dataclass(frozen=True, eq=False)
class ArmTrial:
    """One arm in one trial.

    Parameters
    ----------
    needed
        Torque of the shoulder without support, in parts, at the times of the trial.
    elevation
        Of the arm [rad].
    current
        Of the tool [A].
    lever
        Middle of the cuff from the shoulder [m].
    motion
        Of the upper arm in the device's frame, smoothed and without gaps, at the same times.
    wearer
        To whom the device is adjusted.
    """

    name: str
    person: str
    task: str
    hand: Hand
    needed: ElevationTorque
    elevation: Float[np.ndarray, " t"]
    current: Float[np.ndarray, " t"]
    lever: float
    motion: ArmMotion
    wearer: Wearer


@dataclass(frozen=True)
class Support:
    """What the device can do.

    Parameters
    ----------
    torque
        At factor 1, of the elevation of its arm [rad] to [N m]; in proportion at other factors.
    lag
        Time constant of the pressure [s].
    """

    torque: Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, " t"]]
    lag: float


@dataclass(frozen=True)
class ModelError:
    """Standard deviations of what the model does not know of a person.

    Parameters
    ----------
    weight
        Of the arm's mass, relative; invented, about the scatter between regressions of segment masses.
    push
        Of the push force, relative; invented.
    elevation
        Of the device's elevation [rad]: the paper's 6.0° (sec. 5.1.1, RMSD while support is desired).
    sensing
        Of the controller.
    """

    weight: float = 0.10
    push: float = 0.20
    elevation: float = np.radians(6.0)
    sensing: Sensing = field(default_factory=Sensing)


def support_case(trial: ArmTrial, support: Support, thresholds: Thresholds | None = None) -> SupportCase:
    """The case as the model has it: true angle and current at the controller, no delay."""
    return _case(trial, support, trial.needed.total, trial.elevation, (trial.elevation, trial.current), thresholds)


def varied_case(
    trial: ArmTrial,
    support: Support,
    error: ModelError,
    rng: np.random.Generator,
    thresholds: Thresholds | None = None,
) -> SupportCase:
    """The case with errors drawn: one of each kind for the whole trial, sensor noise for each sample."""
    parts = trial.needed
    heavier, harder = 1.0 + error.weight * rng.normal(), 1.0 + error.push * rng.normal()
    needed = heavier * (parts.weight + parts.motion) + parts.tool + harder * parts.push
    elevation = trial.elevation + error.elevation * rng.normal()
    signals = sensed(parts.time, elevation, trial.current, error.sensing, rng)
    return _case(trial, support, needed, elevation, signals, thresholds)


def _case(
    trial: ArmTrial,
    support: Support,
    needed: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    signals: tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]],
    thresholds: Thresholds | None,
) -> SupportCase:
    time = trial.needed.time
    return SupportCase(
        trial.name,
        trial.person,
        trial.task,
        trial.hand,
        time,
        detected(time, *signals, thresholds),
        needed,
        support.torque(elevation),
        support.lag,
        trial.lever,
    )

"""A recording of an exoskeleton at an elbow: angle and constraint force, and what else was measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class ElbowRecording:
    """One trial.

    Parameters
    ----------
    name
        Of the trial.
    time
        [s], strictly increasing.
    beta
        Angle of the exoskeleton's hinge, flexion positive [rad].
    force
        On the attachment along the limb [N]; positive away from the joint.
    displacement
        Of the compensation joint along the limb [m]; None where it was not recorded.
    pressure
        Of the cuff [Pa]; None where it was not recorded.
    torque
        Of the actuator about the exoskeleton's axis, flexion positive [N m]; None where it was not recorded.
    moment
        Of the cuff on the forearm about the link's end, flexion positive [N m]; None where it was not recorded.
    alpha
        Angle of the person's elbow, flexion positive [rad]; None where it was not recorded.
    target
        Angle that the person was to follow with `beta` [rad]; None where it was not recorded.
    """

    name: str
    time: Float[np.ndarray, " t"]
    beta: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]
    displacement: Float[np.ndarray, " t"] | None = None
    pressure: Float[np.ndarray, " t"] | None = None
    torque: Float[np.ndarray, " t"] | None = None
    moment: Float[np.ndarray, " t"] | None = None
    alpha: Float[np.ndarray, " t"] | None = None
    target: Float[np.ndarray, " t"] | None = None

    @property
    def rate(self) -> Float[np.ndarray, " t"]:
        """Angular speed [rad/s], central differences."""
        return np.asarray(np.gradient(self.beta, self.time))

    @property
    def step(self) -> float:
        """Usual time between samples [s]."""
        return float(np.median(np.diff(self.time)))

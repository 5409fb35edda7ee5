"""One arm in a trial: simulated along the motion recorded in the device and along that without it, and as recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.shoulder.recorded_channels import Channels
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.identify.signals.agreement import Agreement
from geocontact.io.recordings.overhead_study import StudyTrial
from geocontact.shoulder_exoskeleton.work_phases import PHASES

SCREWING = PHASES.index("screw-in")


@dataclass(frozen=True, eq=False)
class StudyCase:
    """An arm in a trial.

    Parameters
    ----------
    within
        Along the motion recorded in the device: the study's group 1.
    without
        Along the motion recorded without it: group 2; None where there is none.
    recorded
        Of this arm's logger and mat; None where there are none.
    errors
        By channel and part of the trial, of `within`; the channel `COPIED` is the human elevation in place of the
        exoskeleton's.
    """

    trial: StudyTrial
    within: SimulatedArm
    without: SimulatedArm | None
    recorded: Channels | None
    errors: Mapping[str, Mapping[str, Agreement]]

    @property
    def name(self) -> str:
        """Trial and arm."""
        return f"{self.trial.name}, {self.within.side} arm"


COPIED = "elevation, copied from the shoulder"
"""What stands beside the simulated elevation: joint angles of the human taken as those of the exoskeleton."""


@dataclass(frozen=True)
class ScrewIn:
    """Means over the screw-in, of one arm: elevations of exoskeleton and shoulder [rad], supporting force [N]."""

    exoskeleton: float
    shoulder: float
    force: float


def screw_in(arm: SimulatedArm) -> ScrewIn:
    """Means over the screw-in; NaN where it was not told."""
    working = arm.phase == SCREWING
    s = arm.simulation
    return ScrewIn(_mean(s.elevation, working), _mean(s.motion.elevation, working), _mean(s.supporting, working))


def _mean(values: Float[np.ndarray, " t"], of: Bool[np.ndarray, " t"]) -> float:
    return float(values[of].mean()) if of.any() else float("nan")

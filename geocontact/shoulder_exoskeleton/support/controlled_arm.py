"""An exoskeleton's arm whose support follows the work phases that its controller detects.

The controller sees the device's own arm, which its support moves. Phases and motion are therefore found together: the
arm is simulated with the phases of the pass before until they are those of its own elevation. The controller looks back
only, so each pass is right at least one change of phase longer than the one before. Its sensors may be late and noisy:
the noise is the same in every pass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.in_cuff import MOST_LOST
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, move_arm
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds, detected
from geocontact.shoulder_exoskeleton.support.sensing import Sensing, sensed

PASSES = 50
"""Simulations until the phases must have settled; the shipped trial takes two or three."""


@dataclass(frozen=True, eq=False)
class Controller:
    """What gives the support its factor.

    Parameters
    ----------
    factors
        By the number of the phase (`work_phases.PHASES`), 0 to 1.
    current
        Of the tool at the motion's frames [A].
    thresholds
        When phases change.
    sensing
        Noise, steps and delay of angle and current; None: exact.
    seed
        Of the noise.
    """

    factors: Float[np.ndarray, " 4"]
    current: Float[np.ndarray, " t"]
    thresholds: Thresholds
    sensing: Sensing | None = None
    seed: int = 0

    def phases(self, time: Float[np.ndarray, " t"], elevation: Float[np.ndarray, " t"]) -> Int[np.ndarray, " t"]:
        """Phase at each frame for an arm of this elevation [rad]."""
        seen = elevation, self.current
        if self.sensing is not None:
            seen = sensed(time, *seen, self.sensing, np.random.default_rng(self.seed))
        return detected(time, *seen, self.thresholds)


@dataclass(frozen=True, eq=False)
class ControlledArm:
    """The arm, and phase and factor that its controller gives at each frame."""

    simulation: ArmSimulation
    phase: Int[np.ndarray, " t"]
    factor: Float[np.ndarray, " t"]


def controlled_arm(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    level: float,
    controller: Controller,
    cuff: Cuff = "point",
    guess: Int[np.ndarray, " t"] | None = None,
    most_lost: float = MOST_LOST,
) -> ControlledArm:
    """Motion of the exoskeleton's arm under a support profile; the cylinder has `level` times the factor's share.

    Parameters
    ----------
    guess
        Phases to begin with, such as those under a similar profile; those of the human elevation unless given. They
        change the time that it takes, not what is found.
    most_lost
        As of `simulate_arm`.

    ArithmeticError as of `simulate_arm`, and where phases do not settle.
    """
    phase = controller.phases(motion.time, motion.elevation) if guess is None else guess
    for _ in range(PASSES):
        factor = controller.factors[phase]
        moved = move_arm(motion, device, wearer, level, factor=factor, cuff=cuff)
        seen = controller.phases(motion.time, moved.elevation)
        if np.array_equal(seen, phase):
            return ControlledArm(moved.simulation(most_lost), phase, factor)
        phase = seen
    raise ArithmeticError(f"the controller's phases have not settled after {PASSES} simulations")

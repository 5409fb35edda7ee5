"""What a support profile does to an arm when the device moves by its own dynamics and its controller senses it.

The choice of a profile takes the cylinder's torque at the human elevation for the torque on the arm. Here the
device's arm is simulated in closed loop (`controlled_arm`); what counts is the moment with which the cuff raises the
upper arm.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.device import Device
from geocontact.shoulder_exoskeleton.in_cuff import OutOfCuffError
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, require_held
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.controlled_arm import ControlledArm, Controller, controlled_arm
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome, outcome_of
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds
from geocontact.shoulder_exoskeleton.support.sensing import Sensing
from geocontact.shoulder_exoskeleton.support.support_case import FactorKey
from geocontact.shoulder_exoskeleton.work_phases import PHASES

DOWN = np.array([0.0, 0.0, -1.0])
"""Of the trunk, in the device's frame."""


@dataclass(frozen=True, eq=False)
class SimulatedSupport:
    """One arm under a profile, and what the profile does to it.

    Parameters
    ----------
    torque
        With which the cuff raises the upper arm [N m].
    force
        In the cuff [N].
    lost
        Whether the sphere is far out of the cuff for so long that nothing of it is a result.
    """

    arm: ControlledArm
    torque: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]
    outcome: SupportOutcome
    lost: bool = False


def simulated_support(
    trial: ArmTrial,
    device: Device,
    factors: Factors,
    sensing: Sensing | None = None,
    seed: int = 0,
    guess: Int[np.ndarray, " t"] | None = None,
    strict: bool = False,
) -> SimulatedSupport:
    """Closed loop along the trial's motion; the person moves as recorded, whatever the support.

    Parameters
    ----------
    sensing
        Of the controller; None: exact.
    seed
        Of its noise.
    guess
        As of `controlled_arm`.

    strict
        Let `OutOfCuffError` pass, in place of a result that is `lost`.

    ArithmeticError as of `controlled_arm`.
    """
    keys = [FactorKey(trial.task, trial.hand, phase) for phase in PHASES]
    shares = np.array([factors.get(key, 0.0) for key in keys])
    control = Controller(shares, trial.current, Thresholds(), sensing, seed)
    arm, lost = controlled_arm(trial.motion, device, trial.wearer, 1.0, control, guess=guess, most_lost=1.0), False
    found = arm.simulation
    try:
        require_held(found)
    except OutOfCuffError:
        if strict:
            raise
        lost = True
    torque = raising_torque(found)
    rate = float(np.abs(np.diff(torque) / np.diff(found.motion.time)).max())
    force = np.linalg.norm(found.told["force"], axis=1)
    outcome = outcome_of(trial.needed.total, torque, float(force.max()), rate)
    outcome = replace(outcome, out_of_cuff=float(found.out_of_cuff.mean()))
    return SimulatedSupport(arm, torque, force, outcome, lost)


def raising_torque(arm: ArmSimulation) -> Float[np.ndarray, " t"]:
    """Moment of the cuff's force about the shoulder that raises the upper arm [N m]; a marker is the shoulder."""
    reach = arm.motion.interface - arm.motion.shoulder
    axis = np.cross(DOWN, reach)
    unit = axis / np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-12)
    return np.asarray(np.einsum("ti,ti->t", unit, np.cross(reach, arm.told["force"])))

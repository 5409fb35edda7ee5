"""An exoskeleton's arm whose support follows the work phases, moved by its own dynamics, and what the support does to
it.

The controller sees the device's own arm, which its support moves. Phases and motion are therefore found together: the
arm is simulated with the phases of the pass before until they are those of its own elevation. The controller looks back
only, so each pass is right at least one change of phase longer than the one before. Its sensors may be late and noisy:
the noise is the same in every pass.

The choice of a profile takes the cylinder's torque at the human elevation for the torque on the arm. Here the
device's arm is simulated in closed loop (`controlled_arm`); what counts is the moment with which the cuff raises the
upper arm.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.cuff_contact import MOST_LOST, Cuff, OutOfCuffError
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, move_arm, require_held
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.controller_numbers import thresholds_of
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome, outcome_of
from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing, Thresholds, detected, sensed
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, Hand
from geocontact.shoulder_exoskeleton.work_phases import PHASES

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


def hand_controller(
    factors: Factors,
    task: str,
    hand: Hand,
    current: Float[np.ndarray, " t"],
    sensing: Sensing | None = None,
    seed: int = 0,
    thresholds: Thresholds | None = None,
) -> Controller:
    """The controller of one hand's arm in a task, with the usual thresholds by default; a phase without a factor has 0.

    Parameters
    ----------
    current
        Of the tool at the motion's frames [A].
    sensing
        Noise, steps and delay; None: exact.
    seed
        Of the noise.
    """
    shares = np.array([factors.get(FactorKey(task, hand, phase), 0.0) for phase in PHASES])
    return Controller(shares, current, thresholds or Thresholds(), sensing, seed)


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
        Phases to begin with, such as those under a similar profile; those of the human elevation by default. They
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


DOWN = np.array([0.0, 0.0, -1.0])
"""Direction of the trunk downwards, in the device's frame."""


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
    limits = thresholds_of(device)
    control = hand_controller(factors, trial.task, trial.hand, trial.current, sensing, seed, limits)
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
    force = np.linalg.norm(found.outputs["force"], axis=1)
    outcome = outcome_of(trial.needed.total, torque, float(force.max()), rate)
    outcome = replace(outcome, out_of_cuff=float(found.out_of_cuff.mean()))
    return SimulatedSupport(arm, torque, force, outcome, lost)


def raising_torque(arm: ArmSimulation) -> Float[np.ndarray, " t"]:
    """Moment of the cuff's force about the shoulder that raises the upper arm [N m]; a marker is the shoulder."""
    reach = arm.motion.interface - arm.motion.shoulder
    axis = np.cross(DOWN, reach)
    unit = axis / np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-12)
    return np.asarray(np.einsum("ti,ti->t", unit, np.cross(reach, arm.outputs["force"])))

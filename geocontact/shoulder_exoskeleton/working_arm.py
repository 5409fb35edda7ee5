"""An exoskeleton's arm along overhead work, under a constant support or a controller, with the phases of the work.

The phases of the work are those of the whole recording (`work_phases`); a controller detects its own, at the time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.support.controlled_arm import Controller, controlled_arm
from geocontact.shoulder_exoskeleton.work_phases import PHASES, work_phases

SCREWING = PHASES.index("screw-in")


@dataclass(frozen=True, eq=False)
class SimulatedArm:
    """One arm and the number of the phase in each frame (`work_phases.PHASES`).

    Parameters
    ----------
    phase
        Phase of the work, from the whole recording.
    detected, factor
        Phase that the controller detects at the time and factor that it gives; None where the support is constant.
    """

    simulation: ArmSimulation
    phase: Int[np.ndarray, " t"]
    detected: Int[np.ndarray, " t"] | None = None
    factor: Float[np.ndarray, " t"] | None = None

    @property
    def side(self) -> Side:
        """Side of the wearer."""
        return self.simulation.motion.side


def arm_at_work(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    level: float,
    *,
    tool: Bool[np.ndarray, " t"] | None = None,
    controller: Controller | None = None,
    cuff: Cuff = "point",
) -> SimulatedArm:
    """Motion of the exoskeleton's arm along the human one, and the phases of the work.

    Parameters
    ----------
    motion
        Filtered and without gaps.
    level
        Share of the cylinder's force, 0 to 1.
    tool
        Whether the tool runs at each frame; without it the arm works while it is near its highest.
    controller
        What gives the support its factor; without one it is constant.
    cuff
        How the arm is held.

    ArithmeticError as of `simulate_arm` and `controlled_arm`; ValueError where the tool never runs while the arm is
    raised.
    """
    if controller is None:
        found = simulate_arm(motion, device, wearer, level, cuff=cuff)
        return SimulatedArm(found, work_phases(motion.elevation, tool))
    led = controlled_arm(motion, device, wearer, level, controller, cuff)
    return SimulatedArm(led.simulation, work_phases(motion.elevation, tool), led.phase, led.factor)


@dataclass(frozen=True)
class ScrewIn:
    """Means over the screw-in, of one arm: elevations of exoskeleton and shoulder [rad], supporting force [N]."""

    exoskeleton: float
    shoulder: float
    force: float


def screw_in(arm: SimulatedArm) -> ScrewIn:
    """Means over the screw-in; NaN where the arm has no such phase."""
    working, s = arm.phase == SCREWING, arm.simulation
    return ScrewIn(_mean(s.elevation, working), _mean(s.motion.elevation, working), _mean(s.supporting, working))


def _mean(values: Float[np.ndarray, " t"], working: Bool[np.ndarray, " t"]) -> float:
    return float(values[working].mean()) if working.any() else float("nan")

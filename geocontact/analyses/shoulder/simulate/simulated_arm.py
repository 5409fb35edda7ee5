"""One simulated arm with the phases of its work."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation


@dataclass(frozen=True, eq=False)
class SimulatedArm:
    """One arm and the number of the phase in each frame (`work_phases.PHASES`).

    Parameters
    ----------
    phase
        Of the work, from the whole recording.
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

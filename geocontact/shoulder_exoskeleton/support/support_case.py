"""One arm in one trial as the choice of a support profile sees it: torque that is needed, torque that could be given.

Support is linear in its factors: the cylinder's force is proportional to its pressure, and the pressure follows the
factor of the phase with a lag of first order, p' = (factor - p) / lag. So the torque is A x, x the factors and column k
of A the full torque times what the lag makes of "phase k". What reaches the arm has another part that no factor
changes, the device's own weight above all: the torque on the arm is own + A x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import exp
from typing import Literal

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel
from geocontact.shoulder_exoskeleton.support.phases import SUPPORTED
from geocontact.shoulder_exoskeleton.work_phases import PHASES

Hand = Literal["dominant", "other"]


@dataclass(frozen=True)
class FactorKey:
    """Which factor of a support profile: the structure of the paper's table 3."""

    task: str
    hand: Hand
    phase: str


@dataclass(frozen=True, eq=False)
class SupportCase:
    """One arm in one trial.

    Parameters
    ----------
    time
        [s], increasing.
    phase
        As the controller detects it.
    needed
        Torque of the shoulder without support [N m].
    full
        Torque of the device on the arm at factor 1 and the elevation of each moment [N m].
    lag
        Time constant of the pressure [s].
    lever
        Middle of the cuff from the axis of elevation [m]: the interface carries the support torque over it.
    own
        Torque on the arm that no factor changes [N m]; 0 where the cylinder's torque counts alone.
    own_force
        The same of the force at the interface [N].
    """

    name: str
    person: str
    task: str
    hand: Hand
    time: Float[np.ndarray, " t"]
    phase: Int[np.ndarray, " t"]
    needed: Float[np.ndarray, " t"]
    full: Float[np.ndarray, " t"]
    lag: float
    lever: float
    own: Float[np.ndarray, " t"] | float = 0.0
    own_force: Float[np.ndarray, " t"] | float = 0.0

    @property
    def keys(self) -> tuple[FactorKey, ...]:
        """Of the factors that act in this case, one for each supported phase."""
        return tuple(FactorKey(self.task, self.hand, PHASES[k]) for k in SUPPORTED)

    @cached_property
    def per_factor(self) -> Float[np.ndarray, "t k"]:
        """A: support torque for each factor being 1 while its phase lasts [N m]."""
        pressures = np.column_stack([lagged(self.time, 1.0 * (self.phase == k), self.lag) for k in SUPPORTED])
        return np.asarray(pressures * self.full[:, None])

    def given(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """The part of the torque on the arm that a profile gives, A x [N m]."""
        return np.asarray(self.per_factor @ [factors[key] for key in self.keys])

    def support(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """Torque on the arm under a profile [N m]."""
        return np.asarray(self.own + self.given(factors))

    def force(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """Force at the interface under a profile [N]."""
        return np.asarray(np.abs(self.own_force + self.given(factors) / self.lever))


@kernel
def lagged(time: Float[np.ndarray, " t"], wanted: Float[np.ndarray, " t"], lag: float) -> Float[np.ndarray, " t"]:
    """p of p' = (wanted - p) / lag from 0, exact for values that are constant between samples."""
    found = np.zeros(time.size)
    for k in range(1, time.size):
        decay = exp(-(time[k] - time[k - 1]) / lag)
        found[k] = wanted[k - 1] + (found[k - 1] - wanted[k - 1]) * decay
    return found

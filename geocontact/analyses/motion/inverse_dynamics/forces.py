"""Generalised forces over time, and what is left over at the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.model import GROUND, Multibody


@dataclass(frozen=True)
class Forces:
    """Generalised forces over time.

    Parameters
    ----------
    time
        [s].
    model
        Whose coordinates they are.
    values
        In its order [N m, N].
    peak
        Largest measured net force, the sum of all plates [N]; 0 without any.
    height
        Of the mass centre above the ground's origin, mean over time [m].
    """

    time: Float[np.ndarray, " t"]
    model: Multibody
    values: Float[np.ndarray, "t n"]
    peak: float
    height: float

    @property
    def at_ground(self) -> Bool[np.ndarray, " n"]:
        """Coordinates of joints to the ground that free a body of it, six at one joint."""
        joints = [joint for joint in self.model.joints for _ in joint.coordinates]
        return np.array([joint.parent == GROUND and len(joint.coordinates) == 6 for joint in joints], dtype=bool)

    @property
    def weight(self) -> float:
        """Of all bodies [N]."""
        return self.model.mass * float(np.linalg.norm(self.model.gravity))

    @property
    def residual_forces(self) -> Float[np.ndarray, " t"]:
        """Size of the force left over there [N]; 0 where no body is free."""
        return self._left("translational")

    @property
    def residual_moments(self) -> Float[np.ndarray, " t"]:
        """Root of the sum of squares of the moments along the coordinates there [N m]; 0 where no body is free."""
        return self._left("rotational")

    @property
    def residual(self) -> float:
        """Size of the force left over there, root mean square [N]; NaN where no body is free."""
        return float(np.sqrt(np.mean(self.residual_forces**2))) if self.at_ground.any() else float("nan")

    def _left(self, kind: str) -> Float[np.ndarray, " t"]:
        which = np.array([c.kind == kind for c in self.model.coordinates], dtype=bool)
        return np.asarray(np.linalg.norm(self.values[:, self.at_ground & which], axis=1))

    @property
    def names(self) -> tuple[str, ...]:
        """Columns as OpenSim calls them: knee_angle_r_moment, pelvis_tx_force."""
        return tuple(f"{c.name}_{'moment' if c.kind == 'rotational' else 'force'}" for c in self.model.coordinates)

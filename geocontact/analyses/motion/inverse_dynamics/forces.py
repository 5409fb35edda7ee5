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
        Largest measured force on one body [N]; 0 without any.
    """

    time: Float[np.ndarray, " t"]
    model: Multibody
    values: Float[np.ndarray, "t n"]
    peak: float

    @property
    def at_ground(self) -> Bool[np.ndarray, " n"]:
        """Coordinates of joints to the ground that free a body of it, six at one joint."""
        joints = [joint for joint in self.model.joints for _ in joint.coordinates]
        return np.array([joint.parent == GROUND and len(joint.coordinates) == 6 for joint in joints], dtype=bool)

    @property
    def residual(self) -> float:
        """Size of the force left over there, root mean square [N]; NaN where no body is free."""
        straight = np.array([c.kind == "translational" for c in self.model.coordinates], dtype=bool)
        left = self.values[:, self.at_ground & straight]
        return float(np.sqrt(np.mean(np.sum(left**2, axis=1)))) if left.size else float("nan")

    @property
    def names(self) -> tuple[str, ...]:
        """Columns as OpenSim calls them: knee_angle_r_moment, pelvis_tx_force."""
        return tuple(f"{c.name}_{'moment' if c.kind == 'rotational' else 'force'}" for c in self.model.coordinates)

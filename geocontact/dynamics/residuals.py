"""Generalised forces of inverse dynamics, and the residuals at the joint to the ground.

The joint that frees a body from the ground has no muscle: what acts along its six coordinates is what motion, masses
and measured loads do not agree upon. Limits are those of Hicks et al. (2015), Is my model good enough? J Biomech Eng
137, 020905, and of OpenSim's documentation, "Getting Started with RRA".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.data.wrench import Wrench

FORCE, MOMENT = 0.05, 0.01
"""Shares of the largest net external force, and of that times the height of the mass centre."""
GOOD, OKAY = 10.0, 25.0
"""N that OpenSim calls good and okay after residual reduction."""


@dataclass(frozen=True)
class GeneralisedForces:
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
        Largest measured net force, the sum of all loads [N]; 0 without any.
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
    def residual_forces(self) -> Float[np.ndarray, " t"]:
        """Size of the residual force [N]; 0 where no body is free."""
        return self._sizes("translational")

    @property
    def residual_moments(self) -> Float[np.ndarray, " t"]:
        """Root of the sum of squares of the residual moments along the coordinates [N m]; 0 where no body is free."""
        return self._sizes("rotational")

    @property
    def residual(self) -> float:
        """Size of the residual force, root mean square [N]; NaN where no body is free."""
        return float(np.sqrt(np.mean(self.residual_forces**2))) if self.at_ground.any() else float("nan")

    def _sizes(self, kind: str) -> Float[np.ndarray, " t"]:
        which = np.array([c.kind == kind for c in self.model.coordinates], dtype=bool)
        return np.asarray(np.linalg.norm(self.values[:, self.at_ground & which], axis=1))

    @property
    def names(self) -> tuple[str, ...]:
        """Columns as OpenSim calls them: knee_angle_r_moment, pelvis_tx_force."""
        return tuple(f"{c.name}_{'moment' if c.kind == 'rotational' else 'force'}" for c in self.model.coordinates)

    def largest(self, which: Bool[np.ndarray, " n"]) -> tuple[int, int]:
        """Frame and coordinate of the largest size along these coordinates; 0 and 0 where all are 0."""
        sizes = np.abs(np.where(which, self.values, 0.0))
        frame, coordinate = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
        return int(frame), int(coordinate)


@dataclass(frozen=True)
class Peak:
    """The largest size of a residual, when it is [s], and what it is measured by, in the same unit; 0 for nothing.

    Parameters
    ----------
    size
        [N] or [N m].
    time
        [s].
    whole
        Size that the residual is a share of, in the unit of `size`; 0 where there is none.
    allowed
        Largest share that Hicks et al. accept.
    """

    size: float
    time: float
    whole: float
    allowed: float

    @property
    def share(self) -> float:
        """Share of what it is measured by; NaN where that is nothing."""
        return self.size / self.whole if self.whole > 0.0 else float("nan")

    @property
    def too_large(self) -> bool:
        """Whether it is beyond what is allowed."""
        return self.share > self.allowed


def force_residual(forces: GeneralisedForces) -> Peak:
    """Residual of the force [N], by the largest measured force, or by the weight where nothing was measured."""
    whole = forces.peak if forces.peak > 0.0 else forces.model.weight
    return _peak(forces, forces.residual_forces, whole, FORCE)


def moment_residual(forces: GeneralisedForces) -> Peak:
    """Residual of the moments along the coordinates [N m], by the largest measured force at the height of the mass
    centre.
    """
    return _peak(forces, forces.residual_moments, forces.peak * forces.height, MOMENT)


def _peak(forces: GeneralisedForces, sizes: Float[np.ndarray, " t"], whole: float, allowed: float) -> Peak:
    frame = int(np.argmax(sizes))
    return Peak(float(sizes[frame]), float(forces.time[frame]), whole, allowed)


def verdict(size: float) -> str:
    """What OpenSim calls a largest residual force [N] after residual reduction: good, okay or bad."""
    return "good" if size <= GOOD else "okay" if size <= OKAY else "bad"


def largest_net_force(loads: Mapping[str, Wrench]) -> float:
    """Largest size over time of the sum of all forces, (t, 3) each, in one frame [N]; 0 without loads."""
    net = sum((wrench.force for wrench in loads.values()), start=np.zeros((1, 3)))
    return float(np.linalg.norm(net, axis=1).max())


def mean_height(model: Multibody, values: Float[np.ndarray, "t n"]) -> float:
    """Height of the mass centre above the ground's origin, mean over the rows of coordinates [rad, m]; 0 without
    gravity [m].
    """
    return float(np.mean(model.mass_centre(values) @ model.up)) if model.gravity.any() else 0.0

"""A prescribed rotation about an axis: flexion from 0 to 90 degrees without a recorded motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.motion import Motion


@dataclass(frozen=True)
class Axis:
    """A line in space: point [m] and direction of any length, in FIXED's frame.

    >>> import geocontact as gc, numpy as np
    >>> axis = gc.Axis(point=(0.0, 0.0, 0.0), direction=(0.0, 0.0, 1.0))
    >>> axis.turned(np.array([gc.deg(90)])).apply([1.0, 0.0, 0.0]).round(6).tolist()
    [[0.0, 1.0, 0.0]]
    """

    point: tuple[float, float, float]
    direction: tuple[float, float, float]

    def __post_init__(self) -> None:
        length = np.linalg.norm(self.direction)
        if not np.isfinite([*self.point, *self.direction]).all() or length == 0.0:
            raise ValueError(f"an axis needs a finite point and a direction of some length, not {self.direction}")

    def turned(self, angle: Float[np.ndarray, " t"]) -> RigidTransform:
        """Rotations by `angle` [rad], right-handed about the direction, that leave the axis in place."""
        unit = np.asarray(self.direction, float) / np.linalg.norm(self.direction)
        rotation = Rotation.from_rotvec(np.asarray(angle)[:, None] * unit)
        point = np.asarray(self.point, float)
        return RigidTransform.from_components(point - rotation.apply(point), rotation)


def sweep(axis: Axis, start: float, stop: float, step: float, name: str = "angle") -> Motion:
    """MOVING turned about `axis` from start [rad] in steps up to stop, which is included when the steps meet it.

    MOVING's own frame coincides with FIXED's at angle 0. One frame a second, so that there is a time.

    Parameters
    ----------
    axis
        Line in FIXED's frame [m].
    start, stop, step
        Angles [rad], right-handed about the axis.
    name
        Of the angle, as tables and figures have it.

    Raises
    ------
    ValueError
        The steps do not lead from start to stop.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> flexion = gc.sweep(gc.Axis((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), 0.0, gc.deg(90), gc.deg(30))
    >>> np.degrees(flexion.coordinate[1]).round(6).tolist()
    [0.0, 30.0, 60.0, 90.0]
    """
    angle = swept_angles(start, stop, step)
    time = np.arange(len(angle), dtype=float)
    return Motion(time, axis.turned(angle), f"sweep of {name}", coordinate=(name, angle))


def swept_angles(start: float, stop: float, step: float) -> Float[np.ndarray, " t"]:
    """Angles from start in steps up to stop [rad], which is included when the steps meet it; ValueError without."""
    if step == 0.0 or not np.isfinite([start, stop, step]).all() or (stop - start) * step < 0.0:
        raise ValueError(f"a sweep from {start} to {stop} cannot go in steps of {step}")
    return np.asarray(start + step * np.arange(int(np.floor((stop - start) / step + 1e-9)) + 1))

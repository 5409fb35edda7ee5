"""A joint as OpenSim defines it: pose of the child body in the parent body as a function of coordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint_function import JointFunction

Kind = Literal["rotational", "translational", "coupled"]


@dataclass(frozen=True)
class Coordinate:
    """A generalised coordinate of a joint; numbers in rad or m.

    Parameters
    ----------
    name
        As motion files call it.
    default
        Value where nothing else is said.
    kind
        Decides whether a file in degrees has this column in degrees: only where it is "rotational". A "coupled"
        coordinate drives an axis by something other than itself (a spline, a factor) and stays in rad or m.
    limits
        Range that the model states; infinite where it states none.
    clamped
        Whether the model keeps the coordinate within its range.
    locked
        Whether the model keeps the coordinate at its default.
    """

    name: str
    default: float
    kind: Kind
    limits: tuple[float, float] = (-math.inf, math.inf)
    clamped: bool = False
    locked: bool = False


@dataclass(frozen=True)
class TransformAxis:
    """One of the six motions of a spatial transform: `function` of `coordinates` about or along `direction`."""

    direction: Float[np.ndarray, " 3"]
    coordinates: tuple[str, ...]
    function: JointFunction


@dataclass(frozen=True)
class JointModel:
    """A joint between two bodies.

    `X_PC(q) = parent_offset · X_J(q) · child_offset⁻¹`, with X_J inverted where `reverse` is set (OpenSim 3, and joints
    of OpenSim 4 whose child is the one nearer to the ground: the functions then give the parent in the child). X_J
    turns about three body-fixed axes in turn and then shifts by the sum of three displacements, all expressed in the
    joint frame of the body that `base` names.
    """

    name: str
    parent: str
    child: str
    coordinates: tuple[Coordinate, ...]
    axes: tuple[TransformAxis, ...]
    parent_offset: RigidTransform
    child_offset: RigidTransform
    reverse: bool
    file: str

    def pose(self, q: Mapping[str, Float[np.ndarray, " t"]], frames: int) -> RigidTransform:
        """`X_PC` for each frame, translation in m; coordinates [rad, m] by name, absent ones at their default."""
        full = {c.name: q.get(c.name, np.full(frames, c.default)) for c in self.coordinates}
        amounts = [_amount(axis, full, frames) for axis in self.axes]
        turned = [
            Rotation.from_rotvec(amount[:, None] * axis.direction)
            for axis, amount in zip(self.axes[:3], amounts[:3], strict=True)
        ]
        shift = sum(amount[:, None] * axis.direction for axis, amount in zip(self.axes[3:], amounts[3:], strict=True))
        moved = RigidTransform.from_components(np.asarray(shift), turned[0] * turned[1] * turned[2])
        return self.parent_offset * (moved.inv() if self.reverse else moved) * self.child_offset.inv()

    @property
    def base(self) -> str:
        """The body in whose joint frame X_J turns and shifts: the parent, the child where `reverse` is set."""
        return self.child if self.reverse else self.parent

    def stretch(self, slot: int, by: Float[np.ndarray, " 3"]) -> float:
        """How much a shift along an axis (3, 4, 5 among `axes`) grows where `base` does by these factors."""
        offset = self.child_offset if self.reverse else self.parent_offset
        return float(np.linalg.norm(offset.rotation.apply(self.axes[slot].direction) * by))

    def turned_round(self) -> JointModel:
        """The same joint with parent and child exchanged."""
        return replace(
            self,
            parent=self.child,
            child=self.parent,
            parent_offset=self.child_offset,
            child_offset=self.parent_offset,
            reverse=not self.reverse,
        )


def _amount(axis: TransformAxis, q: Mapping[str, Float[np.ndarray, " t"]], frames: int) -> Float[np.ndarray, " t"]:
    named = [q[name] for name in axis.coordinates]
    return axis.function(np.column_stack(named) if named else np.zeros((frames, 0)))

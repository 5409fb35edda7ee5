"""A joint as OpenSim defines it, the functions that move its axes, and the kinds that are made in Python.

Files have these and more (`io.opensim.osim`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation


@dataclass(frozen=True)
class Affine:
    """`slopes · q + offset`; without slopes a constant."""

    slopes: Float[np.ndarray, " k"]
    offset: float

    def __call__(self, q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        return np.asarray(q @ self.slopes + self.offset)

    def scaled(self, factor: float) -> Affine:
        """The function times a number."""
        return Affine(factor * self.slopes, factor * self.offset)


@dataclass(frozen=True)
class Piecewise:
    """Polynomials of one coordinate, one more than there are knots; the outermost go on for ever.

    Parameters
    ----------
    knots
        Where one piece ends and the next begins, increasing.
    origins, coefficients
        Piece i is Σ `coefficients[i, n]` (q - `origins[i]`)^(d - n): the highest power comes first.
    """

    knots: Float[np.ndarray, " m"]
    origins: Float[np.ndarray, " p"]
    coefficients: Float[np.ndarray, "p d"]

    def __call__(self, q: Float[np.ndarray, "t 1"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        i = np.searchsorted(self.knots, q[:, 0], side="right")
        x = q[:, 0] - self.origins[i]
        value = self.coefficients[i, 0]
        for power in range(1, self.coefficients.shape[1]):
            value = value * x + self.coefficients[i, power]
        return np.asarray(value)

    def scaled(self, factor: float) -> Piecewise:
        """The function times a number."""
        return Piecewise(self.knots, self.origins, factor * self.coefficients)


@dataclass(frozen=True)
class SineProduct:
    """`factor · Π sin(q_k + phases_k)`, as points of an ellipsoid have it."""

    factor: float
    phases: tuple[float, ...]

    def __call__(self, q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        return np.asarray(self.factor * np.prod(np.sin(q + np.array(self.phases)), axis=1))

    def scaled(self, factor: float) -> SineProduct:
        """The function times a number."""
        return SineProduct(factor * self.factor, self.phases)


JointFunction = Affine | Piecewise | SineProduct


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


Vector = Float[np.ndarray, " 3"]
_STILL, _ITSELF = Affine(np.zeros(0), 0.0), Affine(np.ones(1), 0.0)
_AXES = np.eye(3)


def revolute(
    name: str,
    parent: str,
    child: str,
    axis: Vector,
    at: RigidTransform | None = None,
    child_at: RigidTransform | None = None,
) -> JointModel:
    """One turn about an axis; the coordinate has the joint's name [rad].

    Parameters
    ----------
    axis
        In the joint's frame, of any length.
    at, child_at
        Pose of the joint's frame in the parent and in the child, their own frames by default.
    """
    return _joint(name, parent, child, [(0, axis, name)], at, child_at)


def prismatic(
    name: str,
    parent: str,
    child: str,
    axis: Vector,
    at: RigidTransform | None = None,
    child_at: RigidTransform | None = None,
) -> JointModel:
    """One shift along an axis; the coordinate has the joint's name [m]. Arguments as for `revolute`."""
    return _joint(name, parent, child, [(3, axis, name)], at, child_at)


def gimbal(
    name: str, parent: str, child: str, at: RigidTransform | None = None, child_at: RigidTransform | None = None
) -> JointModel:
    """Three turns about x, then the turned y, then the turned z; coordinates `name`_rx, _ry, _rz [rad].

    At a quarter turn about y the first and the last are about one line: the mass matrix is singular there.
    """
    return _joint(name, parent, child, _turns(name), at, child_at)


def free(
    name: str, parent: str, child: str, at: RigidTransform | None = None, child_at: RigidTransform | None = None
) -> JointModel:
    """Three shifts along x, y, z of the parent, `name`_tx, _ty, _tz [m], and the turns of a gimbal.

    Turns come first among the coordinates, as in OpenSim.
    """
    shifts = [(k + 3, _AXES[k], f"{name}_t{'xyz'[k]}") for k in range(3)]
    return _joint(name, parent, child, [*_turns(name), *shifts], at, child_at)


def cardan(
    name: str,
    parent: str,
    child: str,
    turns: Sequence[tuple[str, Vector]],
    shifts: Sequence[tuple[str, Vector]] = (),
    at: RigidTransform | None = None,
    child_at: RigidTransform | None = None,
) -> JointModel:
    """Up to three turns, each about an axis that the ones before it have turned, and up to three shifts.

    Parameters
    ----------
    turns, shifts
        Names of the coordinates [rad, m] and their axes in the joint's frame; shifts are along those of the parent.
    at, child_at
        As for `revolute`.

    ValueError for more than three of either.
    """
    if max(len(turns), len(shifts)) > 3:
        raise ValueError(f"joint {name}: {len(turns)} turns and {len(shifts)} shifts; three of each at most")
    moves = [(first + k, axis, each) for first, of in ((0, turns), (3, shifts)) for k, (each, axis) in enumerate(of)]
    return _joint(name, parent, child, moves, at, child_at)


def weld(
    name: str, parent: str, child: str, at: RigidTransform | None = None, child_at: RigidTransform | None = None
) -> JointModel:
    """No motion."""
    return _joint(name, parent, child, [], at, child_at)


def _turns(name: str) -> list[tuple[int, Vector, str]]:
    return [(k, _AXES[k], f"{name}_r{'xyz'[k]}") for k in range(3)]


def _joint(
    name: str,
    parent: str,
    child: str,
    moves: list[tuple[int, Vector, str]],
    at: RigidTransform | None,
    child_at: RigidTransform | None,
) -> JointModel:
    axes = [TransformAxis(direction, (), _STILL) for direction in (*_AXES, *_AXES)]
    coordinates = []
    for slot, direction, coordinate in moves:
        length = float(np.linalg.norm(direction))
        if not 0.0 < length < np.inf:
            raise ValueError(f"joint {name}: an axis of length {length:g}")
        axes[slot] = TransformAxis(np.asarray(direction, float) / length, (coordinate,), _ITSELF)
        kind: Kind = "rotational" if slot < 3 else "translational"
        coordinates.append(Coordinate(coordinate, 0.0, kind))
    none = RigidTransform.identity()
    ends = (none if at is None else at, none if child_at is None else child_at)
    return JointModel(name, parent, child, tuple(coordinates), tuple(axes), *ends, reverse=False, file="")

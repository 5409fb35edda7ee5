"""Joints of a tree made in Python: revolute, prismatic, gimbal, free, cardan, weld.

Files have these and more (`io.opensim.osim`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import Coordinate, JointModel, Kind, TransformAxis
from geocontact.data.multibody.joint_function import Affine

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
        Pose of the joint's frame in the parent and in the child, their own frames unless given.
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

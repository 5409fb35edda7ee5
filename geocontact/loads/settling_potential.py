"""Energy of a loaded component on an elastic foundation, with its derivatives to the coordinates.

Axes are those of Grood and Suntay (1983), J Biomech Eng 105:136, as `data.multibody.knee_angles` has them, with MOVING
the femoral component and FIXED the tibial one (x anterior, y proximal, z to the right):
R = Ry(rotation) Rx(adduction) Rz(flexion). Translations are those of one point of MOVING along FIXED's axes. Signs are
those of the axes; which turn is varus or internal depends on the side.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import FoundationState, Layer, foundation_state

NAMES = ("anterior", "axial", "mediolateral", "rotation", "adduction", "flexion")
"""Translations along x, y, z of FIXED; turns about y of FIXED, the floating axis, and z of MOVING."""

AXIAL, FLEXION = NAMES.index("axial"), NAMES.index("flexion")


@dataclass(frozen=True, eq=False)
class Placed:
    """Where MOVING is: x_fixed = rotation x_moving + translation; `point` is the place of its point in FIXED [m].

    `turns` (3, 3) has the axes of rotation, adduction and flexion as rows.
    """

    rotation: Float[np.ndarray, "3 3"]
    translation: Float[np.ndarray, " 3"]
    point: Float[np.ndarray, " 3"]
    turns: Float[np.ndarray, "3 3"]

    def to_coordinates(
        self, slope: Float[np.ndarray, " 6"], stiffness: Float[np.ndarray, "6 6"]
    ) -> tuple[Float[np.ndarray, " 6"], Float[np.ndarray, "6 6"]]:
        """Derivatives to displacement and turn about the point as derivatives to the coordinates.

        Turns do not commute: to second order a, then b about the axes e, f is the turn a e + b f + a b e x f / 2.
        """
        jacobian = np.zeros((6, 6))
        jacobian[:3, :3] = np.eye(3)
        jacobian[3:, 3:] = self.turns.T
        out = jacobian.T @ stiffness @ jacobian
        for i in range(3):
            for j in range(i + 1, 3):
                more = 0.5 * float(slope[3:] @ np.cross(self.turns[i], self.turns[j]))
                out[3 + i, 3 + j] += more
                out[3 + j, 3 + i] += more
        return jacobian.T @ slope, out


def placed_at(values: Float[np.ndarray, " 6"], point: Float[np.ndarray, " 3"]) -> Placed:
    """MOVING at coordinates in the order of `NAMES` [m, rad]; `point` is the one that moves, in MOVING's frame."""
    turn = float(values[3])
    rotation = Rotation.from_euler("YXZ", values[3:]).as_matrix()
    floating = np.array([np.cos(turn), 0.0, -np.sin(turn)])
    return Placed(
        rotation=rotation,
        translation=values[:3] - rotation @ point,
        point=values[:3].copy(),
        turns=np.array([[0.0, 1.0, 0.0], floating, rotation @ np.array([0.0, 0.0, 1.0])]),
    )


def coordinates_of(poses: RigidTransform, point: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "t 6"]:
    """Coordinates of poses of MOVING in FIXED, in the order of `NAMES`."""
    rotation = poses.rotation
    return np.hstack([poses.apply(point).reshape(-1, 3), rotation.as_euler("YXZ").reshape(-1, 3)])


def poses_of(values: Float[np.ndarray, "t 6"], point: Float[np.ndarray, " 3"]) -> RigidTransform:
    """The inverse of `coordinates_of`."""
    rotation = Rotation.from_euler("YXZ", values[:, 3:])
    return RigidTransform.from_components(values[:, :3] - rotation.apply(point), rotation)


@dataclass(frozen=True, eq=False)
class Bed:
    """A rigid component over an elastic layer.

    Parameters
    ----------
    layer
        Of FIXED.
    moving, normals
        The component and its `corner_normals`.
    point
        Of MOVING, in its frame [m]: its translations are the coordinates, and the load acts there.
    """

    layer: Layer
    moving: Surface
    normals: Float[np.ndarray, "m 3 3"]
    point: Float[np.ndarray, " 3"]
    _last: dict[bytes, FoundationState] = field(default_factory=dict, init=False, repr=False)

    def state(self, at: Placed) -> FoundationState:
        """Energy, slope and stiffness at a place; that of the last place is kept, where the next search begins."""
        place = b"".join(each.tobytes() for each in (at.rotation, at.translation, at.point))
        found = self._last.get(place)
        if found is None:
            found = foundation_state(self.layer, self.moving, self.normals, at.rotation, at.translation, at.point)
            self._last.clear()
            self._last[place] = found
        return found


@dataclass(frozen=True, eq=False)
class AxialLoad:
    """What acts on the component besides the foundation.

    Parameters
    ----------
    load
        Towards FIXED, along -y of its frame [N].
    springs
        Stiffness of each coordinate [N/m, N m/rad]; 0 without.
    rest
        Coordinates at which the springs are at rest [m, rad].
    """

    load: float
    springs: Float[np.ndarray, " 6"]
    rest: Float[np.ndarray, " 6"]


@dataclass(frozen=True, eq=False)
class Total:
    """Energy of everything at some coordinates.

    Parameters
    ----------
    values
        The coordinates [m, rad].
    potential
        Stored energy and the load's [J].
    slope, stiffness
        First and second derivative to the coordinates: slope 0 is equilibrium.
    springs
        Energy of the springs [J].
    foundation
        State of the layer.
    """

    values: Float[np.ndarray, " 6"]
    potential: float
    slope: Float[np.ndarray, " 6"]
    stiffness: Float[np.ndarray, "6 6"]
    springs: float
    foundation: FoundationState

    @property
    def stored(self) -> float:
        """Energy of layer and springs [J]."""
        return self.foundation.energy + self.springs


def total_at(bed: Bed, pull: AxialLoad, values: Float[np.ndarray, " 6"]) -> Total:
    """Energy and its derivatives at `values`."""
    at = placed_at(values, bed.point)
    state = bed.state(at)
    slope, stiffness = at.to_coordinates(state.slope, state.stiffness)
    off = values - pull.rest
    stretched = pull.springs * off
    springs = 0.5 * float(stretched @ off)
    slope = slope + stretched
    slope[AXIAL] += pull.load
    potential = state.energy + springs + pull.load * float(values[AXIAL])
    return Total(values, potential, slope, stiffness + np.diag(pull.springs), springs, state)

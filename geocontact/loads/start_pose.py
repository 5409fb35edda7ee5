"""Where a component lies on another one before anything is recorded: at each flexion, in the lowest place nearby.

Without load a rigid component comes to rest where it is lowest in touch. The place is searched from middle over middle
downhill, by steps along x and z that are halved (compass search), turns held at 0. A dished insert has one such place;
on a flat one every place is as low, and the middle stays.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.separation import Collider, brought_together, settle
from geocontact.geometry.surface import Surface
from geocontact.loads.settling_potential import AXIAL, Bed, placed_at, poses_of

DOWN = (0.0, -1.0, 0.0)
STEP = 0.02e-3
"""m; how far it is pushed on at a time after the first touch."""
FIRST_TOUCH_FARTHEST = 3e-3
"""m; beyond this it is not the layer that is touched."""


def pressing(bed: Bed, values: Float[np.ndarray, " 6"], fixed: Surface) -> Float[np.ndarray, " 6"] | None:
    """`values` with the axial one at which the layer begins to be pressed; None where the bodies miss each other."""
    at = placed_at(values, bed.point)
    pose = RigidTransform.from_components(at.translation, Rotation.from_matrix(at.rotation))
    try:
        touching = settle(bed.moving, fixed, pose, DOWN)
    except ValueError:
        return None
    lowered = values.copy()
    lowered[AXIAL] += float(touching.translation[1] - at.translation[1])
    for _ in range(round(FIRST_TOUCH_FARTHEST / STEP)):
        lowered[AXIAL] -= STEP
        if bed.state(placed_at(lowered, bed.point)).energy > 0.0:
            return lowered
    return None


FIRST, NEXT, LAST = 4e-3, 1e-3, 0.1e-3
"""m; steps that the search begins with at the first flexion and at the others, and the one that it ends with."""
LOWER = 1e-7
"""m; a place that is lower by less is not."""
FARTHEST = 200
"""Most steps of one search."""


def lowest_places(bed: Bed, fixed: Surface, flexion: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6"]:
    """Coordinates at which MOVING touches FIXED from above, lowest nearby, at each flexion [rad].

    ValueError where it misses FIXED, or slides off its edge without end.
    """
    collider = Collider(bed.moving, fixed)
    values, step = np.zeros(6), FIRST
    found = np.empty((len(flexion), 6))
    for k, angle in enumerate(flexion):
        values[5] = angle
        if k == 0:
            values[:3] += _middle_over_middle(bed, values)
        values = _downhill(bed, collider, values, step)
        found[k], step = values, NEXT
    return found


def _downhill(bed: Bed, collider: Collider, values: Float[np.ndarray, " 6"], step: float) -> Float[np.ndarray, " 6"]:
    best = _touching(bed, collider, values)
    if best is None:
        raise ValueError(f"{bed.moving.name} misses {collider.fixed.name} along -y, middle over middle")
    for _ in range(FARTHEST):
        tried = (_touching(bed, collider, best + step * side * unit) for unit, side in product(AWAY, (1.0, -1.0)))
        lower = [at for at in tried if at is not None and at[AXIAL] < best[AXIAL] - LOWER]
        if lower:
            best = min(lower, key=lambda at: float(at[AXIAL]))
        elif step <= LAST:
            return best
        else:
            step *= 0.5
    raise ValueError(f"{bed.moving.name} finds no lowest place on {collider.fixed.name}: it slides off")


AWAY = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
"""Anterior and mediolateral."""


def _touching(bed: Bed, collider: Collider, values: Float[np.ndarray, " 6"]) -> Float[np.ndarray, " 6"] | None:
    """The same with the axial coordinate of first touch; None where the bodies miss each other."""
    pose = _pose(bed, values)
    try:
        touching = brought_together(collider, pose, DOWN)
    except ValueError:
        return None
    lowered = values.copy()
    lowered[AXIAL] += float(touching.translation[1] - pose.translation[1])
    return lowered


def _pose(bed: Bed, values: Float[np.ndarray, " 6"]) -> RigidTransform:
    pose = poses_of(values[None, :], bed.point)
    return RigidTransform.from_components(pose.translation[0], pose.rotation[0])


def _middle_over_middle(bed: Bed, values: Float[np.ndarray, " 6"]) -> Float[np.ndarray, " 3"]:
    """Way from where MOVING's box is to above the layer's [m]."""
    moved = _pose(bed, values).apply(bed.moving.vertices[bed.moving.used])
    layer = bed.layer.pieces.point
    way = 0.5 * (layer.min(axis=0) + layer.max(axis=0) - moved.min(axis=0) - moved.max(axis=0))
    way[1] = layer[:, 1].max() - moved[:, 1].min()
    return np.asarray(way)

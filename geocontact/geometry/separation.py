"""Exact distance between two bodies and whether they collide, by python-fcl; settling one onto the other."""

from __future__ import annotations

import fcl
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.surface import Surface

CLOSE = 1e-9  # m; settling stops when the gap is below this


class Collider:
    """Two surfaces prepared for exact separation queries.

    Triangle against triangle, so edges and faces count as well as vertices. Degenerate triangles are left out: the
    library answers about 0 for them, and in a surface their neighbours cover the same points.
    """

    def __init__(self, moving: Surface, fixed: Surface) -> None:
        self.moving = moving
        self.fixed = fixed
        self._models = (_model(moving), _model(fixed))

    def _objects(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> tuple[fcl.CollisionObject, fcl.CollisionObject]:
        # both models are held about their own centres, which keeps far offsets out of the arithmetic
        shift = rotation @ self.moving.centre + translation - self.fixed.centre
        moved = fcl.CollisionObject(self._models[0], fcl.Transform(rotation, shift))
        return moved, fcl.CollisionObject(self._models[1], fcl.Transform())

    def collide(self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]) -> bool:
        """Whether the surfaces intersect when MOVING is placed at x_fixed = rotation x + translation [m]."""
        moved, fixed = self._objects(rotation, translation)
        return bool(fcl.collide(moved, fixed, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)

    def distance(self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]) -> float:
        """Smallest distance between the two surfaces [m]; 0 when they intersect."""
        if self.collide(rotation, translation):
            return 0.0
        moved, fixed = self._objects(rotation, translation)
        return max(float(fcl.distance(moved, fixed, fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)


def _model(surface: Surface) -> fcl.BVHModel:
    sound = surface.faces[surface.face_normal.any(axis=1)]
    if len(sound) == 0:
        raise ValueError(f"{surface.name}: every face is degenerate")
    model = fcl.BVHModel()
    model.beginModel(len(surface.vertices), len(sound))
    model.addSubModel(surface.local, sound)
    model.endModel()
    return model


def separation(moving: Surface, fixed: Surface, pose: RigidTransform) -> float:
    """Smallest distance [m] between two surfaces with MOVING at `pose` in FIXED's frame; 0 when they intersect.

    Parameters
    ----------
    moving, fixed
        The two surfaces, each in its own frame [m].
    pose
        Of MOVING in FIXED's frame.

    Examples
    --------
    >>> import geocontact as gc
    >>> from scipy.spatial.transform import RigidTransform
    >>> ball, plate = (gc.read_surface(f"meshes/{name}.stl", "mm") for name in ("sphere_r20", "plate_80x80x12"))
    >>> round(gc.separation(ball, plate, RigidTransform.from_translation([0.0, 0.05, 0.0])), 4)
    0.03
    """
    return Collider(moving, fixed).distance(pose.rotation.as_matrix(), np.asarray(pose.translation))


def settle(
    moving: Surface,
    fixed: Surface,
    pose: RigidTransform,
    direction: tuple[float, float, float],
    steps: int = 10_000,
) -> RigidTransform:
    """Pose at which MOVING, coming along `direction` (in FIXED's frame), first touches FIXED.

    MOVING is first withdrawn until the bodies are clear of one another, then advanced by their exact distance again and
    again (conservative advancement: a translation by s cannot close a gap larger than s), so the first contact is not
    passed over. Stops at a gap below 1e-9 m.

    Parameters
    ----------
    moving, fixed
        The two surfaces, each in its own frame [m].
    pose
        Of MOVING in FIXED's frame: its rotation, and a place on its way.
    direction
        Of that way, of any length, in FIXED's frame.
    steps
        Advances at most.

    Raises
    ------
    ValueError
        The bodies miss each other, or glide along each other without touching within `steps`.

    Examples
    --------
    >>> import geocontact as gc
    >>> from scipy.spatial.transform import RigidTransform
    >>> ball, plate = (gc.read_surface(f"meshes/{name}.stl", "mm") for name in ("sphere_r20", "plate_80x80x12"))
    >>> pose = gc.settle(ball, plate, RigidTransform.from_translation([0.0, 0.05, 0.0]), (0.0, -1.0, 0.0))
    >>> gc.separation(ball, plate, pose) < 1e-9
    True
    """
    return brought_together(Collider(moving, fixed), pose, direction, steps)


def brought_together(
    collider: Collider, pose: RigidTransform, direction: tuple[float, float, float], steps: int = 10_000
) -> RigidTransform:
    """`settle` of two bodies that are prepared already, for many poses."""
    moving, fixed = collider.moving, collider.fixed
    way = np.asarray(direction, float)
    if not np.linalg.norm(way) > 0.0:
        raise ValueError("the direction of settling has no length")
    way = way / np.linalg.norm(way)
    rotation = pose.rotation.as_matrix()
    start = np.asarray(pose.translation, float)
    middle = (rotation @ moving.centre + start - fixed.centre) @ way
    size = _radius(moving) + _radius(fixed)
    travel = -(size + middle)  # withdrawn so far that the bounding spheres only touch
    for _ in range(steps):
        gap = collider.distance(rotation, start + travel * way)
        if gap < CLOSE:
            return RigidTransform.from_components(start + travel * way, pose.rotation)
        travel += gap
        if travel > size - middle:
            raise ValueError(f"{moving.name} misses {fixed.name} along {tuple(direction)}")
    raise ValueError(f"{moving.name} glides along {fixed.name} without touching within {steps} steps")


def _radius(surface: Surface) -> float:
    return float(np.linalg.norm(surface.local[surface.used], axis=1).max())

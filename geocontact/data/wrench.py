"""A force and a moment about a point: of one contact, of many together, of a force plate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

Vector = Float[np.ndarray, " 3"]


@dataclass(frozen=True)
class Wrench:
    """Force and moment about `origin`, one or a stack of them, all in one frame.

    Parameters
    ----------
    force
        [N].
    moment
        About `origin` [N m].
    origin
        The point that the moment refers to [m].
    frame
        Name of the frame all three are given in.
    """

    force: Float[np.ndarray, "*t 3"]
    moment: Float[np.ndarray, "*t 3"]
    origin: Float[np.ndarray, "*t 3"]
    frame: str

    def moved_to(self, origin: Float[np.ndarray, "*s 3"]) -> Wrench:
        """The same load with its moment about another point [m]: one for all, or one each."""
        arm = self.origin - origin
        there = np.broadcast_to(np.asarray(origin, float), self.force.shape)
        return Wrench(self.force, self.moment + np.cross(arm, self.force), there, self.frame)

    def seen_from(self, pose: RigidTransform, frame: str) -> Wrench:
        """The same load in another frame; `pose` maps points of this frame into that one."""
        turn = pose.rotation.as_matrix()
        return Wrench(self.force @ turn.T, self.moment @ turn.T, self.origin @ turn.T + pose.translation, frame)

    def pressing(self, normal: Vector, gate: float) -> Bool[np.ndarray, "*t"]:
        """Where the force along `normal` (unit) reaches `gate` [N], either way: below it no centre means anything."""
        along = np.abs(self.force @ normal)
        return np.asarray((along >= gate) & (along > 0.0))

    def centre_of_pressure(self, point: Vector, normal: Vector, gate: float = 0.0) -> Float[np.ndarray, "*t 3"]:
        """Point of the plane through `point` [m] with unit `normal` about which the moment is parallel to the normal.

        NaN where the force along the normal is below `gate` [N] or zero: the point runs to infinity there (332 m in a
        published recording). On a plate whose normal is z this is (Oz Fx - My)/Fz, (Mx + Oz Fy)/Fz with Oz the height
        of its surface above the origin of the moment.
        """
        height = (self.origin - point) @ normal
        foot = self.moved_to(self.origin - height[..., None] * normal)
        loaded = self.pressing(normal, gate)
        along = np.where(loaded, self.force @ normal, np.nan)
        return np.asarray(foot.origin + np.cross(normal, foot.moment) / along[..., None])

    def free_moment(self, centre: Float[np.ndarray, "*t 3"], normal: Vector) -> Float[np.ndarray, "*t"]:
        """Moment about the unit `normal` through `centre`, the centre of pressure [N m]; NaN where that is NaN."""
        return np.asarray(self.moved_to(centre).moment @ normal)

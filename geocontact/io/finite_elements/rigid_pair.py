"""Two rigid surfaces, one of which moves, as finite-element programs prescribe it: mm, N, MPa, s, rad."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

MM = 1e3
MPA_PER_MM = 1e-9
"""Pa/m in MPa/mm."""
SMALL = 1e-12
"""rad; a shorter rotation vector has no direction."""


@dataclass(frozen=True, eq=False)
class RigidPair:
    """Two surfaces and the motion of one of them in the frame of the other.

    The reference configuration is the first frame: MOVING's nodes are written where they are then, and the motion that
    is prescribed begins with zero. A node x of MOVING is at c + u + R (x − c) later, c being MOVING's origin in the
    first frame.

    Parameters
    ----------
    time
        Time of each frame, strictly increasing [s]; a single one counts as a frame that lasts 1 s.
    poses
        `X_FM` of each frame [m].
    fixed, moving
        Vertices in the body's own frame [m] and faces, counter-clockwise seen from outside.
    touching
        Faces of FIXED that may touch; all of them where None. All of MOVING's may.
    stiffness
        Pressure by depth of the layer [Pa/m]; None where no contact law is known.
    young, poisson
        Elastic constants of FIXED's layer [Pa], [-]; None without one.
    notes
        Sentences about the model, one line each, for the head of the file.
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    fixed: tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]
    moving: tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "j 3"]]
    touching: Bool[np.ndarray, " m"] | None = None
    stiffness: float | None = None
    young: float | None = None
    poisson: float | None = None
    notes: tuple[str, ...] = ()

    @property
    def clock(self) -> Float[np.ndarray, " s"]:
        """Time of the frames from the first one on [s], which is where solvers begin; at least two."""
        return np.array([0.0, 1.0]) if len(self.time) == 1 else self.time - self.time[0]

    @property
    def _known(self) -> RigidTransform:
        """Poses at `clock`."""
        return RigidTransform.concatenate([self.poses] * 2) if len(self.time) == 1 else self.poses

    @property
    def fixed_nodes(self) -> Float[np.ndarray, "n 3"]:
        """Vertices of FIXED in its frame [mm]."""
        return self.fixed[0] * MM

    @property
    def moving_nodes(self) -> Float[np.ndarray, "k 3"]:
        """Vertices of MOVING in FIXED's frame in the first frame [mm]."""
        return np.asarray(self._known[0].apply(self.moving[0])) * MM

    @property
    def centre(self) -> Float[np.ndarray, " 3"]:
        """MOVING's origin in FIXED's frame in the first frame [mm]."""
        return np.asarray(self._known.translation[0]) * MM

    @property
    def displacement(self) -> Float[np.ndarray, "s 3"]:
        """Displacement of `centre` from the first frame to each one [mm]."""
        return np.asarray(self._known.translation - self._known.translation[0]) * MM

    @property
    def rotation(self) -> Float[np.ndarray, "s 3"]:
        """Rotation vector from the first frame to each one, in FIXED's axes and without jumps by whole turns [rad]."""
        turns = self._known.rotation
        return without_jumps((turns * turns[0].inv()).as_rotvec())

    @property
    def velocity(self) -> Float[np.ndarray, "r 3"]:
        """Velocity of MOVING's origin between frames [mm/s]."""
        return np.diff(self.displacement, axis=0) / np.diff(self.clock)[:, None]

    @property
    def angular_velocity(self) -> Float[np.ndarray, "r 3"]:
        """Angular velocity between frames in FIXED's axes [rad/s]: constant, along the shortest arc."""
        turns = self._known.rotation
        steps: Rotation = turns[1:] * turns[:-1].inv()
        return steps.as_rotvec() / np.diff(self.clock)[:, None]

    def contact_faces(self) -> tuple[Int[np.ndarray, " a"], Int[np.ndarray, " b"]]:
        """Numbers of the faces of FIXED and MOVING that may touch."""
        faces, some = self.fixed[1], self.touching
        fixed = np.arange(len(faces)) if some is None else np.flatnonzero(some)
        return fixed, np.arange(len(self.moving[1]))


def without_jumps(vectors: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3"]:
    """The same rotations, each vector the one of those that differ by whole turns that is nearest to the one before.

    A rotation vector longer than π is as good as one that is shorter by 2 π and has the opposite direction; programs
    that interpolate components between frames must not be given the jump from one to the other.

    >>> without_jumps(np.array([[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]])).round(4).tolist()
    [[3.0, 0.0, 0.0], [3.2832, 0.0, 0.0]]
    """
    found = np.array(vectors, dtype=float)
    for k in range(1, len(found)):
        angle = float(np.linalg.norm(found[k]))
        before = found[k - 1]
        if angle < SMALL:
            length = float(np.linalg.norm(before))
            axis = before / length if length > SMALL else np.array([1.0, 0.0, 0.0])
        else:
            axis = found[k] / angle
        turns = np.round((before @ axis - angle) / (2.0 * np.pi))
        found[k] = axis * (angle + 2.0 * np.pi * turns)
    return found

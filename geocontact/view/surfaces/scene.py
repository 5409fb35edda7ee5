"""What is shown: both bodies with their distances, at one time or over a motion, in FIXED's frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform


@dataclass(frozen=True)
class ContactScene:
    """Two bodies at one time.

    Parameters
    ----------
    fixed_vertices, fixed_faces
        FIXED, in its own frame [m].
    distance
        Signed distance of FIXED's vertices to MOVING [m]; infinite where it was not asked for (negative: deep inside).
    moving_vertices, moving_faces
        MOVING, placed in FIXED's frame [m].
    thresholds
        Largest distances that count as contact [m].
    time
        Time of the scene [`time_unit`].
    signed
        False when MOVING is open and has no inside.
    time_unit
        "s", "%" of a cycle, or "deg" where an angle is swept.
    """

    fixed_vertices: Float[np.ndarray, "n 3"]
    fixed_faces: Int[np.ndarray, "m 3"]
    distance: Float[np.ndarray, " n"]
    moving_vertices: Float[np.ndarray, "k 3"]
    moving_faces: Int[np.ndarray, "l 3"]
    thresholds: tuple[float, ...]
    time: float = 0.0
    signed: bool = True
    time_unit: str = "s"

    def __post_init__(self) -> None:
        _require_thresholds(self.thresholds)
        _require_distances(self.distance)


@dataclass(frozen=True)
class MappedBody:
    """A body in its own frame [m] and the signed distance [m] of its vertices to the other body in each frame.

    Distances are infinite where they were not asked for (negative: deep inside). `pressure` is that of its faces [Pa]
    where it was computed, `wear` the depth that they lose [m].
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    distance: Float[np.ndarray, "t n"]
    pressure: Float[np.ndarray, "t m"] | None = None
    wear: Float[np.ndarray, " m"] | None = None

    def __post_init__(self) -> None:
        _require_distances(self.distance)


@dataclass(frozen=True)
class ContactSeries:
    """Two bodies over a motion.

    Parameters
    ----------
    time
        Time of each frame [`time_unit`].
    poses
        `X_FM` of each frame: maps points of MOVING's frame into FIXED's frame; translation in m.
    fixed, moving
        The bodies with their distances.
    thresholds
        Largest distances that count as contact [m].
    signed
        Whose distances are signed, as in `AreaEvolution`: "both", "fixed", "moving" or "none"; FIXED's are when MOVING
        is closed.
    time_unit
        "s", or "%" of a cycle.
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    fixed: MappedBody
    moving: MappedBody
    thresholds: tuple[float, ...]
    signed: str = "both"
    time_unit: str = "s"

    def __post_init__(self) -> None:
        _require_thresholds(self.thresholds)
        if self.signed not in ("both", "fixed", "moving", "none"):
            raise ValueError(f"signed is {self.signed!r}, not both, fixed, moving or none")
        counts = (len(self.time), len(self.poses), len(self.fixed.distance), len(self.moving.distance))
        if len(set(counts)) > 1 or counts[0] == 0:
            raise ValueError("times, poses and distances are of {}, {}, {} and {} frames".format(*counts))

    def __len__(self) -> int:
        return len(self.time)

    def placed(self, frame: int) -> Float[np.ndarray, "k 3"]:
        """MOVING's vertices in FIXED's frame [m]."""
        return np.asarray(self.poses[frame].apply(self.moving.vertices))

    def scene(self, frame: int) -> ContactScene:
        """Both bodies at one frame."""
        return ContactScene(
            fixed_vertices=self.fixed.vertices,
            fixed_faces=self.fixed.faces,
            distance=self.fixed.distance[frame],
            moving_vertices=self.placed(frame),
            moving_faces=self.moving.faces,
            thresholds=self.thresholds,
            time=float(self.time[frame]),
            signed=self.signed in ("both", "fixed"),
            time_unit=self.time_unit,
        )


def _require_thresholds(thresholds: tuple[float, ...]) -> None:
    if not thresholds or min(thresholds) < 0.0 or not np.isfinite(thresholds).all():
        raise ValueError("thresholds must be finite and not negative")


def _require_distances(distance: np.ndarray) -> None:
    if np.isnan(distance).any():
        raise ValueError("a distance is not a number; it is infinite where it was not asked for")

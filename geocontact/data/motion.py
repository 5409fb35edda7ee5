"""Recorded or prescribed motion of one body in the frame of another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from geocontact.data.frame_blocks import worked


@dataclass(frozen=True)
class Signals:
    """Columns of a table over time, SI units (rad, m, N) unless `units` says otherwise.

    `units[c]` is "" where the file does not tell what column c is in.
    """

    time: Float[np.ndarray, " t"]
    values: Float[np.ndarray, "t c"]
    channels: tuple[str, ...]
    units: tuple[str, ...]

    def column(self, name: str) -> Float[np.ndarray, " t"]:
        """Values of one channel; KeyError when there is none of that name."""
        if name not in self.channels:
            raise KeyError(name)
        return np.asarray(self.values[:, self.channels.index(name)])


@dataclass(frozen=True)
class Course:
    """Name, unit and value of what runs from frame to frame."""

    name: str
    unit: str
    values: Float[np.ndarray, " t"]

    @property
    def label(self) -> str:
        """For an axis: "time [s]"."""
        return f"{self.name} [{self.unit}]"

    def at(self, frame: int) -> str:
        """In words: "0.56 s", "flexion 57 deg"."""
        value = f"{self.values[frame]:g} {self.unit}"
        return value if self.name == "time" else f"{self.name} {value}"


MATRIX = 16
"""Entries of the matrix of a pose."""
SAME_TIME = 1e-6
"""Seconds (or per cent of a cycle) that two clocks may differ by and still tell the same time."""


def poses_in_parts(made: Callable[..., RigidTransform], *columns: Float[np.ndarray, "t ..."]) -> RigidTransform:
    """The poses that `made` gives for each part of columns of the same frames; matrices of many lie in a file.

    >>> shift = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]])
    >>> poses_in_parts(RigidTransform.from_translation, shift).translation.tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]
    """
    matrices = worked(lambda *some: made(*some).as_matrix(), *columns, each=MATRIX)
    return RigidTransform(matrices, normalize=False, copy=False)


@dataclass(frozen=True)
class Motion:
    """Poses of MOVING in the frame of FIXED, one per time.

    Parameters
    ----------
    time
        Time of each frame [s], strictly increasing (normalised cycles keep their own scale; see `time_unit`).
    poses
        `X_FM`: maps points given in MOVING's frame into FIXED's frame; translation in m.
    source
        Where it came from, for the record ("gait.mot with joint knee_r of knee.osim").
    time_unit
        "s", or "%" where the file says that its cycle is normalised.
    coordinate
        Name and values [rad] of the angle that a prescribed motion sweeps; None for recorded motion.
    heeded
        Which of the reader's options "order", "angles" and "convention" had a say in it.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> from scipy.spatial.transform import RigidTransform
    >>> poses = RigidTransform.from_translation([[0.0, 0.0, 0.0], [0.0, 0.01, 0.0]])
    >>> motion = gc.Motion(np.array([0.0, 1.0]), poses)
    >>> motion.at(np.array([0.5])).poses.translation.tolist()
    [[0.0, 0.005, 0.0]]
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    source: str = ""
    time_unit: str = "s"
    coordinate: tuple[str, Float[np.ndarray, " t"]] | None = None
    heeded: frozenset[str] = frozenset()

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        unit = "" if self.time_unit == "%" else " "
        span = f"{self.time[0]:g} … {self.time[-1]:g}{unit}{self.time_unit}" if len(self) else "no time"
        return f"<Motion, {len(self)} frames, {span}{f', {self.source}' if self.source else ''}>"

    def at(self, time: Float[np.ndarray, " k"]) -> Motion:
        """The motion at other times within its own: translations linear, rotations along the shortest arc between."""
        if len(time) == len(self.time) and np.allclose(time, self.time, rtol=0.0, atol=SAME_TIME):
            return self
        if time[0] < self.time[0] - SAME_TIME or time[-1] > self.time[-1] + SAME_TIME:
            known = f"{self.time[0]:g} to {self.time[-1]:g} {self.time_unit}"
            raise ValueError(f"is known from {known} only, not from {time[0]:g} to {time[-1]:g}")
        inside = np.clip(time, self.time[0], self.time[-1])
        shifts = np.column_stack([np.interp(inside, self.time, column) for column in self.poses.translation.T])
        poses = RigidTransform.from_components(shifts, Slerp(self.time, self.poses.rotation)(inside))
        return replace(self, time=time, poses=poses)

    def relative_to(self, fixed: Motion) -> Motion:
        """Poses of this body in the body that `fixed` moves, both given in one frame, such as the laboratory's.

        X_FM = X_LF^-1 X_LM at this motion's times, to which the other one is interpolated (`at`).
        """
        if fixed.time_unit != self.time_unit:
            raise ValueError(f"is over {fixed.time_unit}, the other motion over {self.time_unit}")
        source = f"{self.source} relative to {fixed.source}"
        poses = fixed.at(self.time).poses.inv() * self.poses
        return replace(self, poses=poses, source=source, heeded=self.heeded | fixed.heeded)

    def turned(self, axis: tuple[float, float, float], angle: float) -> Motion:
        """The motion with MOVING turned in every frame about a direction of FIXED through MOVING's origin [rad]."""
        turn = Rotation.from_rotvec(angle * np.asarray(axis))
        poses = RigidTransform.from_components(self.poses.translation, turn * self.poses.rotation)
        return replace(self, poses=poses)

    @property
    def course(self) -> Course:
        """Along what the frames follow each other, as an axis shows it: time, the cycle, or the angle swept."""
        if self.coordinate is not None:
            name, angle = self.coordinate
            return Course(name, "deg", np.degrees(angle))
        return Course("cycle", "%", self.time) if self.time_unit == "%" else Course("time", "s", self.time)

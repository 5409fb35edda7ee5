"""Recorded or prescribed motion of one body in the frame of another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation


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
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    source: str = ""
    time_unit: str = "s"
    coordinate: tuple[str, Float[np.ndarray, " t"]] | None = None
    heeded: frozenset[str] = frozenset()

    def __len__(self) -> int:
        return len(self.time)

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

"""Frames of a mat on a segment that moves: those for which there is a pose, and loads carried to another frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.bodies import read_body_motion
from geocontact.analyses.frame.collector import note, reserve
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.recording import TOUCH, PreparedFrames
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import worked
from geocontact.data.motion import Motion
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.register.landmarks import poses_at
from geocontact.loads.mat_load import COVARIANCE, MatLoad, covariance_in, load_in


@dataclass(frozen=True, eq=False)
class Travel:
    """Poses X_GB of the segment at the mat's frames, and the name of G."""

    poses: RigidTransform
    frame: str

    def carried(
        self,
        whole: MatLoad,
        parts: Mapping[str, MatLoad],
        covariance: Float[np.ndarray, "t six six"],
        point: Float[np.ndarray, " 3"],
    ) -> tuple[MatLoad, dict[str, MatLoad], Float[np.ndarray, "t six six"]]:
        """Loads about one point of the segment as loads about `point` of G [m]."""
        origin = whole.wrench.origin[0]
        return (
            load_in(whole, self.poses, point, self.frame),
            {name: load_in(part, self.poses, point, self.frame) for name, part in parts.items()},
            worked(
                lambda part, k: covariance_in(part, origin, self.poses[k], point),
                covariance,
                np.arange(len(covariance)),
                each=COVARIANCE,
            ),
        )


def read_segment_motion(o: MatOptions) -> Motion | None:
    """Poses of the segment over time; None where it is not said to move."""
    if o.motion is None:
        return None
    motion = read_body_motion(o.motion, o)
    if len(motion) < 2:
        raise InputError("", "`motion`", f"{o.motion} holds one pose", "two are needed")
    return motion


def followed(seen: PreparedFrames, motion: Motion | None, o: MatOptions) -> tuple[PreparedFrames, Travel | None]:
    """The frames for which there is a pose, and the poses; all frames and None where nothing moves."""
    if motion is None:
        return seen, None
    time, low, high = seen.frames.time, float(motion.time[0]), float(motion.time[-1])
    inside = (time >= low - TOUCH) & (time <= high + TOUCH)
    span = f"the mat has frames from {time[0]:g} to {time[-1]:g} s and the motion poses from {low:g} to {high:g} s"
    if not inside.any():
        raise InputError(o.motion or "", "", f"no frame has a pose: {span}", "bring both to one clock")
    left_out = int((~inside).sum())
    if left_out:
        reserve(f"{left_out} of {len(time)} frames are left out, they have no pose: {span}")
    poses = poses_at(motion.time, motion.poses, np.clip(time[inside], low, high))
    frame = o.frame or _name(o)
    note("motion", {"source": motion.source, "frame": frame, "poses": len(motion), "frames_left_out": left_out})
    chosen = replace(seen, frames=_only(seen.frames, inside), read=_only(seen.read, inside))
    return chosen, Travel(poses, frame)


def _name(o: MatOptions) -> str:
    """What the motion leads to, in words."""
    if o.joint is not None:
        return f"of the {'child' if o.moving_body == 'parent' else 'parent'} body of joint {o.joint}"
    return f"that {Path(str(o.motion)).name} leads to"


def _only(frames: PressureFrames, chosen: Bool[np.ndarray, " t"]) -> PressureFrames:
    """The chosen frames, which follow each other: times grow."""
    first, last = np.flatnonzero(chosen)[[0, -1]]
    return replace(frames, time=frames.time[first : last + 1], pressure=frames.pressure[first : last + 1])

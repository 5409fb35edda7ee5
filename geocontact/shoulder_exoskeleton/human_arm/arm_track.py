"""Joints of one arm in the laboratory, from markers, with the axis about which the shoulder raises it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.identify.signals.zero_lag import zero_lag
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.from_markers.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.from_markers.marker_names import ELBOW, FINGER, SHOULDER, UPPER, WRIST
from geocontact.shoulder_exoskeleton.from_markers.reference import MAP

Places = Float[np.ndarray, "t 3"]
VANISHING = 1e-6
"""Sine of the elevation below which the axis of elevation is not defined; the torque about it tends to 0 there."""


@dataclass(frozen=True)
class ArmTrack:
    """One arm in an inertial frame.

    Parameters
    ----------
    time
        [s], evenly spaced.
    shoulder, elbow, wrist, hand
        Joints, and the grip at the third metacarpal [m].
    down
        Of the trunk, unit vectors: elevation is counted from it.
    """

    side: Side
    time: Float[np.ndarray, " t"]
    shoulder: Places
    elbow: Places
    wrist: Places
    hand: Places
    down: Places

    def raising(self) -> Places:
        """Unit axes about which the upper arm is raised, positive away from `down`; 0 where it hangs along it."""
        axis = np.cross(self.down, self.elbow - self.shoulder)
        length = np.linalg.norm(self.elbow - self.shoulder, axis=1)
        size = np.maximum(np.linalg.norm(axis, axis=1), VANISHING * length)
        return np.asarray(axis / size[:, None])


def arm_track(markers: MarkerTrajectories, frame: DeviceFrame, side: Side) -> ArmTrack:
    """Track of one arm at the markers' times; InputError for a marker that is missing or not always seen.

    Parameters
    ----------
    frame
        Of the device, at the same times: its -z is the trunk's down.
    """
    upper = UPPER[side] if UPPER[side] in markers.names else SHOULDER[side]
    names = (upper, ELBOW[side], WRIST[side], FINGER[side])
    missing = [name for name in names if name not in markers.names]
    if missing:
        what = f"no marker {', '.join(missing)}, which the weight of the {side} arm needs"
        raise InputError(markers.source, "", what, MAP)
    places = markers.of(names)
    lost = [name for k, name in enumerate(names) if not np.isfinite(places[:, k]).all()]
    if lost or not np.isfinite(frame.rotation).all():
        what = f"{', '.join(lost) or 'a reference marker of the device'} is not seen in all frames"
        raise InputError(markers.source, "", what, "fill the gaps first")
    shoulder, elbow, wrist, hand = np.moveaxis(places, 1, 0)
    return ArmTrack(side, markers.time, shoulder, elbow, wrist, hand, -frame.rotation[:, 2])


def smoothed(track: ArmTrack, cutoff: float) -> ArmTrack:
    """The track through a zero-lag low-pass [Hz]."""
    step = float(track.time[1] - track.time[0])
    joints = np.stack((track.shoulder, track.elbow, track.wrist, track.hand))
    shoulder, elbow, wrist, hand = zero_lag(joints.swapaxes(0, 1), step, cutoff).swapaxes(0, 1)
    return ArmTrack(track.side, track.time, shoulder, elbow, wrist, hand, track.down)

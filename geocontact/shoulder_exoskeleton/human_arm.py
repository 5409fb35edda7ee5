"""The human arm: joints from markers, weight, loads of the hands, and the torque with which the shoulder raises it.

Shares of mass and mass centres are those of the person's segments (`data.body_segments`), whose forearm and hand are as
long beside the upper arm.

Segments are rigid and symmetric about their long axes, whose spin two markers do not show; the moment of inertia across
is the mean of de Leva's sagittal and transverse ones. With u the direction of a segment, its angular momentum about the
mass centre is I u × u'. The shoulder joint may move: everything is in an inertial frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.interpolate import make_interp_spline

from geocontact.data.body_segments import BodySegments
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.identify.signals.filters import zero_lag
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.device_frame import (
    ELBOW,
    FINGER,
    MAP,
    SHOULDER,
    UPPER,
    WRIST,
    DeviceFrame,
)

GRAVITY = 9.81
"""m/s²; only ratios of persons count."""
CHAIN = ("upper_arm", "forearm", "hand")
"""From the shoulder outwards."""


def arm_moment(mass: float, segments: BodySegments, upper_arm: float) -> float:
    """About the shoulder, of the arm stretched out level [N m].

    Parameters
    ----------
    mass
        Of the whole body [kg].
    segments
        Segments of the person.
    upper_arm
        Shoulder to elbow [m].
    """
    size = upper_arm / segments[CHAIN[0]].length
    moment, start = 0.0, 0.0
    for name in CHAIN:
        segment = segments[name]
        moment += segment.mass * mass * GRAVITY * size * (start + segment.centre * segment.length)
        start += segment.length
    return moment


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


@dataclass(frozen=True)
class HandLoad:
    """Load of one hand, at its grip.

    Parameters
    ----------
    mass
        Of the tool, a point that moves with the grip [kg].
    force
        What the hand exerts on the work in an inertial frame [N]; the work exerts the opposite on the hand.
    """

    mass: float
    force: Float[np.ndarray, "t 3"]


@dataclass(frozen=True)
class ToolWork:
    """A tool and how it is pushed.

    Parameters
    ----------
    tool
        Mass [kg], in the dominant hand.
    push
        Force on the work while the tool runs [N].
    direction
        Of the push in the laboratory, of any length.
    dominant_share
        Part of the push that the dominant hand exerts, 0 to 1. The paper gives all to it, as it could not measure the
        split, though both hands push in its task T2 (sec. 5.3).
    """

    tool: float
    push: float
    direction: tuple[float, float, float] = (0.0, 1.0, 0.0)
    dominant_share: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.dominant_share <= 1.0:
            raise ValueError(f"the dominant hand cannot exert {self.dominant_share:.0%} of the push")
        if self.tool < 0.0 or self.push < 0.0:
            raise ValueError("tool and push must not be negative")


def hand_load(
    work: ToolWork,
    side: Side,
    dominant: Side,
    running: Bool[np.ndarray, " t"],
    measured: Float[np.ndarray, "t 3"] | None = None,
) -> HandLoad:
    """Load of one hand while the tool runs or not, frame by frame.

    Parameters
    ----------
    measured
        Force of both hands on the work in the laboratory [N], in place of the push while the tool runs.
    """
    leads = side == dominant
    share = work.dominant_share if leads else 1.0 - work.dominant_share
    if measured is not None:
        return HandLoad(work.tool if leads else 0.0, share * measured)
    direction = np.array(work.direction) / np.linalg.norm(work.direction)
    return HandLoad(work.tool if leads else 0.0, share * work.push * running[:, None] * direction)


SPLINE = 5
"""Degree of the splines that are differentiated twice."""
CUTOFF = 6.0
"""Hz, of the low-pass before; usual for human motion (Winter 2009, sec. 3.4)."""


@dataclass(frozen=True)
class ElevationTorque:
    """Torque of one shoulder, positive where it raises the arm [N m], in parts that add up.

    Parameters
    ----------
    weight
        Against the arm's own weight.
    motion
        For the arm's acceleration.
    tool
        Against the tool's weight, and for its acceleration.
    push
        For the force on the work.
    """

    time: Float[np.ndarray, " t"]
    weight: Float[np.ndarray, " t"]
    motion: Float[np.ndarray, " t"]
    tool: Float[np.ndarray, " t"]
    push: Float[np.ndarray, " t"]

    @property
    def total(self) -> Float[np.ndarray, " t"]:
        """All of it."""
        return np.asarray(self.weight + self.motion + self.tool + self.push)


def elevation_torque(
    track: ArmTrack,
    load: HandLoad,
    *,
    mass: float,
    segments: BodySegments,
    gravity: Float[np.ndarray, " 3"],
    cutoff: float | None = CUTOFF,
) -> ElevationTorque:
    """Torque of the shoulder without any support.

    Parameters
    ----------
    mass
        Of the whole body [kg]; lengths of the segments are those between the joints, in the mean over the track.
    segments
        Segments of the person, whose shares of mass and of these lengths count.
    gravity
        In the track's frame [m/s²].
    cutoff
        Of the zero-lag low-pass on the joints [Hz]; None: none.
    """
    joints = track if cutoff is None else smoothed(track, cutoff)
    axis = joints.raising()
    ends = {
        "upper_arm": (joints.shoulder, joints.elbow),
        "forearm": (joints.elbow, joints.wrist),
        "hand": (joints.wrist, joints.hand),
    }
    weight, motion = np.zeros_like(axis), np.zeros_like(axis)
    for name, (near, far) in ends.items():
        segment = segments[name]
        own = segment.mass * mass
        along = far - near
        length = float(np.linalg.norm(along, axis=1).mean())
        sagittal, transverse, _ = segment.moments(own, length)
        centre = near + segment.centre * along
        unit = along / np.linalg.norm(along, axis=1, keepdims=True)
        arm = centre - joints.shoulder
        weight += np.cross(arm, -own * gravity)
        motion += np.cross(arm, own * second_derivative(joints.time, centre))
        motion += 0.5 * (sagittal + transverse) * np.cross(unit, second_derivative(joints.time, unit))
    reach = joints.hand - joints.shoulder
    tool = np.cross(reach, load.mass * (second_derivative(joints.time, joints.hand) - gravity))
    push = np.cross(reach, load.force)
    parts = (np.einsum("ti,ti->t", axis, each) for each in (weight, motion, tool, push))
    return ElevationTorque(joints.time, *parts)


def second_derivative(time: Float[np.ndarray, " t"], values: Places) -> Places:
    """By a spline through all values."""
    return np.asarray(make_interp_spline(time, values, k=SPLINE).derivative(2)(time))

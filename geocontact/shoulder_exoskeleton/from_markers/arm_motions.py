"""Motion of both upper arms in the device's frame, from recorded or virtual markers.

Yao et al. (2024), Robotics 13:27, sec. 2.2. The upper marker drives nothing in the paper; here it gives the elevation
and the place of the human shoulder.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.from_markers.arm_points import (
    ArmPoints,
    arm_points,
    require_arm_length,
    require_steady,
)
from geocontact.shoulder_exoskeleton.from_markers.device_frame import DeviceFrame, device_frame, upright_pitch
from geocontact.shoulder_exoskeleton.from_markers.gaps import require_short_gaps, seen_span
from geocontact.shoulder_exoskeleton.from_markers.marker_names import LOWER, MIDDLE, UPPER
from geocontact.shoulder_exoskeleton.from_markers.reference import MAP, reference_markers
from geocontact.shoulder_exoskeleton.from_markers.sense import require_sense
from geocontact.shoulder_exoskeleton.from_markers.virtual_device import Attachment

SIDES: tuple[Side, ...] = ("right", "left")
GRAVITY = 9.80665


@dataclass(frozen=True)
class MarkerSettings:
    """How markers are turned into motion.

    Parameters
    ----------
    gravity
        In the frame of the markers [m/s²]; OpenSim's y is up.
    upright
        Start and end of a span in which the wearer stands upright [s]; it fixes the pitch of T10. None: T10 is taken
        to lie straight below Lucy_MC.
    gap_limit
        Longest time for which a marker may be out of sight [s].
    attachment
        For a person without the device.
    """

    gravity: tuple[float, float, float] = (0.0, -GRAVITY, 0.0)
    upright: tuple[float, float] | None = None
    gap_limit: float = 0.2
    attachment: Attachment = field(default_factory=Attachment)


@dataclass(frozen=True)
class ArmMotions:
    """What the markers tell.

    Parameters
    ----------
    arms
        Right before left; one of them where only one was recorded.
    frame
        The device in the laboratory, at the times of the arms.
    pitch
        Angle of T10 below Lucy_MC that was used [rad].
    notes
        What was assumed or cut, one sentence each.
    """

    arms: tuple[ArmMotion, ...]
    frame: DeviceFrame
    pitch: float
    notes: tuple[str, ...]

    def of(self, side: Side) -> ArmMotion:
        """One arm; KeyError where it was not recorded."""
        found = [arm for arm in self.arms if arm.side == side]
        if not found:
            raise KeyError(side)
        return found[0]


def arm_motions(markers: MarkerTrajectories, settings: MarkerSettings | None = None) -> ArmMotions:
    """Upper arms in the device's frame; InputError for markers that are missing or cannot be right."""
    settings = settings or MarkerSettings()
    points = {side: arm_points(markers, side, settings.attachment.cuff) for side in SIDES}
    there = {side: found for side, found in points.items() if found is not None}
    if not there:
        pairs = " or ".join(f"{{{UPPER[side]}, {LOWER[side]}}}" for side in SIDES)
        raise InputError(markers.source, "", f"no markers of an upper arm: {pairs}", MAP)
    for side, found in there.items():
        require_arm_length(markers.source, side, found)
        require_steady(markers.source, side, markers.time, found)
    reference = reference_markers(markers, settings.attachment)
    placed = (reference.origin, reference.left, reference.below)
    pitch, assumed = _pitch(markers, placed, settings)
    frame = device_frame(*placed, pitch)
    span, cut = _common_span(markers, frame, there)
    frame = DeviceFrame(frame.origin[span], frame.rotation[span])
    arms = tuple(_arm(markers.time[span], side, there[side], span, frame, settings) for side in there)
    _require_short_gaps(markers, arms, frame, span, settings.gap_limit)
    require_sense(markers.source, arms)
    notes = (reference.note, "" if reference.note else assumed, cut, *(each.note for each in there.values()))
    return ArmMotions(arms, frame, pitch, tuple(note for note in notes if note))


def elevation(shoulder: Float[np.ndarray, "t 3"], interface: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, " t"]:
    """Angle between the upper arm and the device's -z [rad], in any vertical plane: 0 hanging down, π straight up."""
    down_the_arm = interface - shoulder
    return np.asarray(np.arctan2(np.hypot(down_the_arm[:, 0], down_the_arm[:, 1]), -down_the_arm[:, 2]))


def _arm(
    time: Float[np.ndarray, " t"],
    side: Side,
    points: ArmPoints,
    span: slice,
    frame: DeviceFrame,
    settings: MarkerSettings,
) -> ArmMotion:
    shoulder, interface = (frame.points(each[span]) for each in (points.shoulder, points.interface))
    gravity = frame.vectors(np.array(settings.gravity))
    return ArmMotion(side, time, interface, shoulder, elevation(shoulder, interface), gravity)


def _pitch(
    markers: MarkerTrajectories, placed: tuple[Float[np.ndarray, "t 3"], ...], settings: MarkerSettings
) -> tuple[float, str]:
    """Pitch of T10, and what was assumed where no upright stance was named."""
    if settings.upright is None:
        return 0.0, f"T10 is taken to lie straight below {MIDDLE}: no span of upright stance was named"
    start, stop = settings.upright
    kept = (markers.time >= start - 1e-6) & (markers.time <= stop + 1e-6)
    kept &= np.isfinite(np.concatenate(placed, axis=1)).all(axis=1)
    if not kept.any():
        what = f"no frame with all reference markers from {start:g} to {stop:g} s"
        there = f"the recording is from {markers.time[0]:g} to {markers.time[-1]:g} s"
        raise InputError(markers.source, "`upright`", what, there)
    origin, left, below = (each[kept] for each in placed)
    return upright_pitch(origin, left, below, -np.array(settings.gravity)), ""


def _common_span(markers: MarkerTrajectories, frame: DeviceFrame, points: dict[Side, ArmPoints]) -> tuple[slice, str]:
    """Frames from the first to the last in which everything is seen, and what was cut."""
    tracks = [frame.rotation.reshape(-1, 9), *(p for each in points.values() for p in (each.shoulder, each.interface))]
    span = seen_span(np.isfinite(np.concatenate(tracks, axis=1)).all(axis=1))
    if span.stop - span.start < 2:
        what = "there are no two frames in which all markers of arms and device are seen"
        raise InputError(markers.source, "", what, "fill their gaps")
    kept = markers.time[span]
    if len(kept) == len(markers.time):
        return span, ""
    return span, f"used from {kept[0]:.2f} to {kept[-1]:.2f} s, where all markers are seen at both ends"


def _require_short_gaps(
    markers: MarkerTrajectories, arms: tuple[ArmMotion, ...], frame: DeviceFrame, span: slice, limit: float
) -> None:
    time = markers.time[span]
    seen = np.isfinite(frame.rotation).all(axis=(1, 2))
    require_short_gaps("a reference marker of the device", time, seen, limit, markers.source)
    for arm in arms:
        for name, place in ((UPPER[arm.side], arm.shoulder), (LOWER[arm.side], arm.interface)):
            require_short_gaps(name, time, np.isfinite(place).all(axis=1), limit, markers.source)

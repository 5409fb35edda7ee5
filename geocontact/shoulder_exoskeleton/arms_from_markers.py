"""Motion of both upper arms in the device's frame, from recorded or virtual markers.

Yao et al. (2024), Robotics 13:27, sec. 2.2. The upper marker drives nothing in the paper; here it gives the elevation
and the place of the human shoulder.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.identify.signals.filters import filled_and_smoothed
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.device_frame import (
    ELBOW,
    LOWER,
    MAP,
    MIDDLE,
    SHOULDER,
    UPPER,
    Attachment,
    DeviceFrame,
    device_frame,
    reference_markers,
    upright_pitch,
)


def seen_span(seen: Bool[np.ndarray, " t"]) -> slice:
    """Frames from the first to the last that is seen; empty where none is."""
    frames = np.flatnonzero(seen)
    return slice(int(frames[0]), int(frames[-1]) + 1) if len(frames) else slice(0, 0)


def longest_gap(time: Float[np.ndarray, " t"], seen: Bool[np.ndarray, " t"]) -> tuple[float, float]:
    """Times of the frames seen last before and first after the longest gap [s]; equal where there is none.

    ValueError where the first or the last frame is not seen: that is no gap, nothing lies beyond it.
    """
    if not (len(seen) and seen[0] and seen[-1]):
        raise ValueError("the first and the last frame must be seen")
    there = time[seen]
    steps = np.diff(np.flatnonzero(seen))
    lengths = np.where(steps > 1, np.diff(there), 0.0)
    if not len(lengths) or lengths.max() == 0.0:
        return float(time[0]), float(time[0])
    longest = int(np.argmax(lengths))
    return float(there[longest]), float(there[longest + 1])


def require_short_gaps(
    name: str, time: Float[np.ndarray, " t"], seen: Bool[np.ndarray, " t"], limit: float, source: str
) -> None:
    """InputError where a gap is longer than a limit [s]."""
    start, stop = longest_gap(time, seen)
    if stop - start > limit:
        what = f"{name} is not seen from {start:.2f} to {stop:.2f} s, {stop - start:.2g} s; the limit is {limit:g} s"
        raise InputError(source, "", what, "fill the gap, cut the trial with `time`, or raise `gap_limit`")


SHORTEST, LONGEST = 0.05, 0.6
"""Distance of the two points of an upper arm [m] that is plausible; the longest upper arms have about 0.45 m."""
FASTEST = 10.0
"""m/s; no marker of an upper arm is faster, not even in throwing."""
UNLIKE = 0.5
"""Share of their median distance by which both may be nearer or farther: a shoulder's marker slides in lifting."""


@dataclass(frozen=True)
class ArmPoints:
    """Points of one upper arm in the laboratory [m], and how they came about where they were not recorded."""

    shoulder: Float[np.ndarray, "t 3"]
    interface: Float[np.ndarray, "t 3"]
    note: str = ""


def arm_points(markers: MarkerTrajectories, side: Side, cuff: float) -> ArmPoints | None:
    """Points of one arm; None where the recording has no marker of it, InputError where it has one of two.

    Of a person without the device the lower marker, on the skin beside the arm's axis, says where along the axis the
    cuff is; without one it is taken at a share.

    Parameters
    ----------
    cuff
        Share of the way from shoulder to elbow at which the cuff holds an arm without a marker there [-].
    """
    own, person = (UPPER[side], LOWER[side]), (SHOULDER[side], ELBOW[side])
    if set(own) <= set(markers.names):
        return ArmPoints(*np.moveaxis(markers.of(own), 1, 0))
    half = [name for name in own if name in markers.names]
    by_person = set(person) <= set(markers.names)
    if half and not (by_person and half == [LOWER[side]]):
        missing = next(name for name in own if name not in markers.names)
        raise InputError(markers.source, "", f"no marker {missing}, only {half[0]}", MAP)
    if not by_person:
        return None
    shoulder, elbow = np.moveaxis(markers.of(person), 1, 0)
    if half:
        along = elbow - shoulder
        share = np.sum((markers.of((half[0],))[:, 0] - shoulder) * along, axis=1) / np.sum(along * along, axis=1)
        note = f"{side} arm: the cuff is taken where {half[0]} lies along the line from {person[0]} to {person[1]}"
        return ArmPoints(shoulder, shoulder + share[:, None] * along, note)
    note = f"{side} arm: the cuff is taken {cuff:.0%} of the way from {person[0]} to {person[1]} (invented)"
    return ArmPoints(shoulder, shoulder + cuff * (elbow - shoulder), note)


def require_arm_length(source: str, side: Side, points: ArmPoints) -> None:
    """InputError where the points are farther apart than in any arm, nearly one point, or never seen together."""
    lengths = np.linalg.norm(points.interface - points.shoulder, axis=1)
    seen = lengths[np.isfinite(lengths)]
    if not len(seen):
        what = f"no frame shows both markers of the {side} upper arm"
        raise InputError(source, "", what, "fill their gaps, or leave this arm's markers out")
    apart = float(np.median(seen))
    if not SHORTEST <= apart <= LONGEST:
        what = f"the markers of the {side} upper arm are {apart:.3g} m apart, not {SHORTEST:g} to {LONGEST:g} m"
        raise InputError(source, "", what, "is the unit in the file right? are the markers named right?")


def require_steady(source: str, side: Side, time: Float[np.ndarray, " t"], points: ArmPoints) -> None:
    """InputError where a point jumps from one frame to the next that shows it, or both are unlike their distance.

    Such frames are no motion: a marker was taken for another one, or markers have exchanged their names.
    """
    for which, place in (("upper", points.shoulder), ("lower", points.interface)):
        seen = np.flatnonzero(np.isfinite(place).all(axis=1))
        way = np.linalg.norm(np.diff(place[seen], axis=0), axis=1)
        speed = way / np.diff(time[seen])
        if len(speed) and speed.max() > FASTEST:
            k = int(np.argmax(speed > FASTEST))
            jump = f"{1e3 * way[k]:.0f} mm at {time[seen[k + 1]]:.2f} s ({speed[k]:.0f} m/s)"
            what = f"the {which} marker of the {side} upper arm jumps by {jump}"
            raise InputError(source, "", what, "take those frames out; have two markers exchanged their names?")
    apart = np.linalg.norm(points.interface - points.shoulder, axis=1)
    usual = float(np.nanmedian(apart))
    unlike = np.flatnonzero(np.abs(apart - usual) > UNLIKE * usual)
    if len(unlike):
        first = f"{1e3 * apart[unlike[0]]:.0f} mm apart at {time[unlike[0]]:.2f} s"
        what = f"the markers of the {side} upper arm are {first}, {1e3 * usual:.0f} mm in the median"
        raise InputError(source, "", what, "take those frames out; have two markers exchanged their names?")


STEEPEST = np.radians(60.0)
"""Inclination of the device's z in the median beyond which the axes of the file are doubted [rad]."""
BEHIND = 0.05
"""How far the shoulders may lie behind Lucy_MC [m] before left and right are taken to be exchanged everywhere."""


def require_sense(source: str, arms: tuple[ArmMotion, ...]) -> None:
    """Two arms and not one twice, upright, arms on their sides, shoulders before the bar."""
    for one, other in combinations(arms, 2):
        if np.array_equal(one.shoulder, other.shoulder, equal_nan=True):
            what = (
                f"the markers of the {other.side} upper arm are where those of the {one.side} one are, in every frame"
            )
            raise InputError(source, "", what, "columns are copied: give each arm its own, or leave one arm out")
    gravity = np.nanmedian(arms[0].gravity_at_frames(), axis=0)
    tilt = float(np.arctan2(np.hypot(gravity[0], gravity[1]), -gravity[2]))
    if tilt > STEEPEST:
        what = f"the device is inclined {np.degrees(tilt):.0f} degrees from upright"
        raise InputError(source, "", what, "is y up in the file? turn it with `axes`; is T10 the lowest marker?")
    places = {arm.side: np.nanmedian(arm.shoulder, axis=0) for arm in arms}
    sides = {"right": -1.0, "left": 1.0}
    wrong = [side for side, place in places.items() if sides[side] * place[0] < 0.0]
    behind = float(np.median([place[1] for place in places.values()]))
    if wrong or behind > BEHIND:
        what = (
            f"the {wrong[0]} shoulder lies on the {_other(wrong[0])} side of {MIDDLE}"
            if wrong
            else f"the shoulders lie {1e3 * behind:.0f} mm behind {MIDDLE}"
        )
        remedy = "left and right are exchanged, in the arms' markers or in Lucy_Mleft; rename with `markers_map`"
        raise InputError(source, "", what, remedy)


def _other(side: Side) -> Side:
    return "left" if side == "right" else "right"


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


def filled_markers(markers: MarkerTrajectories, longest_gap: float) -> MarkerTrajectories:
    """Markers at even times without gaps; those that begin late or end early are left out.

    Parameters
    ----------
    longest_gap
        Longest time for which a marker may be out of sight [s]; InputError beyond, and where no marker is left.
    """
    known = np.isfinite(markers.positions).all(axis=2)
    whole = [k for k in range(len(markers.names)) if known[0, k] and known[-1, k]]
    if not whole:
        raise InputError(markers.source, "", "no marker is seen from the first to the last frame", "cut the trial")
    names = tuple(markers.names[k] for k in whole)
    columns = markers.positions[:, whole].reshape(len(markers), -1)
    try:
        time, values = filled_and_smoothed(markers.time, columns, cutoff=None, longest_gap=longest_gap)
    except ValueError as error:
        raise InputError(markers.source, "", str(error), "fill the gap, or give a larger `gap_limit`") from error
    return MarkerTrajectories(time, values.reshape(len(time), len(whole), 3), names, markers.source)

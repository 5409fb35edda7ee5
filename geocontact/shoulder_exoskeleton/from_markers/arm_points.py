"""Two points of each upper arm in the laboratory: the sphere in the cuff, and the upper marker."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.from_markers.marker_names import ELBOW, LOWER, SHOULDER, UPPER
from geocontact.shoulder_exoskeleton.from_markers.reference import MAP

SHORTEST, LONGEST = 0.05, 0.6
"""Distance of the two points of an upper arm [m] that is believed; the longest upper arms have about 0.45 m."""
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

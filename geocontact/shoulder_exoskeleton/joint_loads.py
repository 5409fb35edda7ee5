"""What shoulder, elbow and lower back of a person at overhead work carry, with and without an exoskeleton.

Newton's and Euler's equations over the body's segments (`human_arm`), in the laboratory's inertial frame: a joint
provides the force and moment that accelerate and carry everything beyond it. The cuff carries a part of the upper arm,
so that the shoulder provides less; the trunk carries the cuff's reaction and the device's weight and inertia. In the
lower back the cuffs' forces cancel: what remains of the device there is its weight and inertia.

Trunk and head are one straight rod from the hips, in the middle below the shoulders, and a point above it. The legs do
not matter here. Segments are symmetric about their long axes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypedDict

import numpy as np
from jaxtyping import Float

from geocontact.data.body_segments import BodySegments
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.human_arm import VANISHING, ArmTrack, HandLoad, second_derivative

Rows = Float[np.ndarray, "t 3"]
HEAD = 0.40
"""Middle of the head above the shoulders, over the length of the trunk (invented)."""


class PersonNumbers(TypedDict):
    """Mass of the body [kg], its segments, and gravity in the laboratory [m/s²]."""

    mass: float
    segments: BodySegments
    gravity: Float[np.ndarray, " 3"]


@dataclass(frozen=True, eq=False)
class Load:
    """A force [N] at a place [m] and a moment [N m], over time, in the laboratory."""

    force: Rows
    place: Rows
    moment: Rows

    def about(self, point: Rows) -> Rows:
        """Moment about a point [N m]."""
        return np.asarray(self.moment + np.cross(self.place - point, self.force))

    def opposite(self) -> Load:
        """Reaction to this load."""
        return Load(-self.force, self.place, -self.moment)


def added(loads: Sequence[Load], point: Rows) -> Load:
    """All of them as one load at a point."""
    force = np.sum([each.force for each in loads], axis=0)
    return Load(np.asarray(force), point, np.asarray(np.sum([each.about(point) for each in loads], axis=0)))


def needed_by(
    time: Float[np.ndarray, " t"],
    ends: tuple[Rows, Rows],
    segment: str,
    *,
    mass: float,
    segments: BodySegments,
    gravity: Float[np.ndarray, " 3"],
) -> Load:
    """What carries and accelerates one segment, at its mass centre: m (a - g), and I u x u''.

    Parameters
    ----------
    ends
        Proximal and distal end [m].
    mass
        Of the whole body [kg].
    segments
        Its segments.
    """
    near, far = ends
    own = segments[segment]
    size = own.mass * mass
    along = far - near
    length = np.linalg.norm(along, axis=1, keepdims=True)
    sagittal, transverse, _ = own.moments(size, float(length.mean()))
    centre, unit = near + own.centre * along, along / length
    force = size * (second_derivative(time, centre) - gravity)
    turning = 0.5 * (sagittal + transverse) * np.cross(unit, second_derivative(time, unit))
    return Load(np.asarray(force), np.asarray(centre), np.asarray(turning))


@dataclass(frozen=True, eq=False)
class ArmNeeds:
    """What one arm needs at its joints, without any support: force and moment of the trunk at the shoulder, and of
    the upper arm at the elbow.
    """

    shoulder: Load
    elbow: Load


def arm_needs(
    track: ArmTrack, hand: HandLoad, *, mass: float, segments: BodySegments, gravity: Float[np.ndarray, " 3"]
) -> ArmNeeds:
    """Needs of an arm with its hand's load; arguments as those of `elevation_torque`."""
    joints = {
        "upper_arm": (track.shoulder, track.elbow),
        "forearm": (track.elbow, track.wrist),
        "hand": (track.wrist, track.hand),
    }
    upper, fore, palm = (
        needed_by(track.time, ends, name, mass=mass, segments=segments, gravity=gravity)
        for name, ends in joints.items()
    )
    carried = hand.mass * (second_derivative(track.time, track.hand) - gravity)
    grip = Load(np.asarray(carried + hand.force), track.hand, np.zeros_like(track.hand))
    elbow = added((fore, palm, grip), track.elbow)
    return ArmNeeds(added((upper, elbow), track.shoulder), elbow)


def raising_torque(track: ArmTrack, needs: ArmNeeds, cuff: Load | None = None) -> Float[np.ndarray, " t"]:
    """Torque of the shoulder that raises the arm [N m]; `cuff` is what the device does to the upper arm."""
    moment = needs.shoulder.moment if cuff is None else needs.shoulder.moment - cuff.about(track.shoulder)
    return np.asarray(np.einsum("ti,ti->t", track.raising(), moment))


def bending_torque(track: ArmTrack, needs: ArmNeeds) -> Float[np.ndarray, " t"]:
    """Torque of the elbow that bends it [N m]; 0 where the arm is straight, whose axis is not known."""
    axis = np.cross(track.elbow - track.shoulder, track.wrist - track.elbow)
    lengths = np.linalg.norm(track.elbow - track.shoulder, axis=1) * np.linalg.norm(track.wrist - track.elbow, axis=1)
    size = np.maximum(np.linalg.norm(axis, axis=1), VANISHING * lengths)
    return np.asarray(np.einsum("ti,ti->t", axis / size[:, None], needs.elbow.moment))


@dataclass(frozen=True, eq=False)
class Trunk:
    """Trunk and head: hips and shoulders' middle [m] in the laboratory, and the wearer's left (unit vectors)."""

    time: Float[np.ndarray, " t"]
    hips: Rows
    shoulders: Rows
    left: Rows


def trunk_of(tracks: Sequence[ArmTrack], frame: DeviceFrame, length: float) -> Trunk:
    """Trunk between both arms: straight along the device's z, `length` [m] long, below the mean place of the shoulders
    in the device's frame.
    """
    middle = np.mean([frame.points(track.shoulder) for track in tracks], axis=(0, 1))
    middle[0] = 0.0
    top, axes = frame.origin + np.einsum("tij,i->tj", frame.rotation, middle), frame.rotation
    return Trunk(tracks[0].time, np.asarray(top - length * axes[:, 2]), np.asarray(top), np.asarray(axes[:, 0]))


def back_needs(
    trunk: Trunk, arms: Sequence[ArmNeeds], *, mass: float, segments: BodySegments, gravity: Float[np.ndarray, " 3"]
) -> Load:
    """What the pelvis provides at the hips' height for trunk, head and both arms, without any device."""
    torso = needed_by(trunk.time, (trunk.shoulders, trunk.hips), "trunk", mass=mass, segments=segments, gravity=gravity)
    place = trunk.shoulders + HEAD * (trunk.shoulders - trunk.hips)
    size = segments["head"].mass * mass
    head = Load(size * (second_derivative(trunk.time, place) - gravity), place, np.zeros_like(place))
    return added((torso, head, *(each.shoulder for each in arms)), trunk.hips)


def extending_torque(trunk: Trunk, needs: Load, device: Sequence[Mapping[str, Load]] = ()) -> Float[np.ndarray, " t"]:
    """Torque of the lower back that leans the trunk backwards [N m].

    Parameters
    ----------
    device
        Loads on the person of each side of a device, by name; those on arms and trunk add up.
    """
    moment = needs.about(trunk.hips)
    for side in device:
        for load in side.values():
            moment = moment - load.about(trunk.hips)
    return np.asarray(-np.einsum("ti,ti->t", trunk.left, moment))

"""Bodies of a model by poses of segments or orientations of sensors: which is which, how they lie, what counts.

How a segment's frame lies in its body, X_BS, comes from a pose of calibration in which the person stands as the model
does by default: R_BS = R_GBᵀ H R_GS, as OpenSense's IMUPlacer has it (OpenSim 4.6). H turns about the vertical, until
the stated axis of one segment is above or below its body's x axis; IMUPlacer takes the whole angle between both, which
contains the sensor's tilt. H is of the calibration alone: in the recording the model faces where the person does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.quantities import named_file
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.marker_tasks import held_near, weights_typed
from geocontact.analyses.motion.markers import turn_of
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from geocontact.data.multibody.segments import SegmentPoses
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map
from geocontact.io.mocap.segment_poses import read_segments
from geocontact.io.text.tables import listed

ARM = 0.1
"""m; a turn of 1 rad away from a segment counts as so much of a shift: a degree as 1.7 mm."""
SENSOR = "_imu"
"""End of a sensor's name behind its body's, as OpenSense has it."""
THEIA = {
    "pelvis": ("pelvis",),
    "thigh": ("femur",),
    "shank": ("tibia",),
    "foot": ("calcn", "foot"),
    "toes": ("toes",),
    "torso": ("torso",),
    "head": ("head",),
    "uarm": ("humerus",),
    "larm": ("radius", "ulna"),
    "hand": ("hand",),
}
"""Bodies of OpenSim's models by Theia's segments, whose side stands before the name: l_thigh, femur_l."""
AXES = "xyz"
WALKED = 1.0
"""m, from the first to the last frame, from which the way says where somebody faces; our own choice."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments that are used, their bodies, and how they lie in them.

    Parameters
    ----------
    poses
        As recorded, in the model's axes.
    bodies
        One for each segment.
    placed
        X_BS of each; its translation is 0 of sensors, which know no place.
    up
        Unit vector upwards in the model's axes.
    root
        Number of the segment whose body is the nearest to the ground in the tree.
    """

    poses: SegmentPoses
    bodies: tuple[str, ...]
    placed: tuple[RigidTransform, ...]
    up: Float[np.ndarray, " 3"]
    root: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the segments."""
        return self.poses.names

    @property
    def sizes(self) -> tuple[str, ...]:
        """Names of the weights: of each orientation, and of each origin where places are known."""
        return self.names if self.poses.origins is None else (*self.names, *map(origin_of, self.names))

    def markers(self) -> tuple[Marker, ...]:
        """Three directions along the axes of each body, and the origin of its segment where places are known.

        Of length `ARM` / √2: together they count as (`ARM` θ)², as `dynamics.inverse_kinematics` has it.
        """
        found = []
        for name, body, placed in zip(self.names, self.bodies, self.placed, strict=True):
            found += [
                Marker(axis, body, ARM / np.sqrt(2.0) * unit, direction=True)
                for axis, unit in zip(axes_of(name), np.eye(3), strict=True)
            ]
            if self.poses.origins is not None:
                found.append(Marker(origin_of(name), body, np.asarray(placed.translation)))
        return tuple(found)

    def seen(self) -> MarkerTrajectories:
        """The same as recorded: R_GB = R_GS R_BSᵀ."""
        columns: list[Float[np.ndarray, "t 3"]] = []
        there = self.poses.there
        for k, placed in enumerate(self.placed):
            bodies = self.poses.rotations[:, k] @ placed.rotation.as_matrix().T
            shown = np.where(there[:, k, None, None], bodies, np.nan)
            columns += [ARM / np.sqrt(2.0) * shown[:, :, axis] for axis in range(3)]
            if self.poses.origins is not None:
                columns.append(np.where(there[:, k, None], self.poses.origins[:, k], np.nan))
        names = tuple(marker.name for marker in self.markers())
        return MarkerTrajectories(self.poses.time, np.stack(columns, axis=1), names, self.poses.source)

    def off_its_way(self) -> float | None:
        """Level angle between the way of the root's origin and where its x axis points in the mean [rad].

        None of sensors, and where the way from the first to the last frame is shorter than `WALKED`, or less than half
        as long as the furthest from the first: who comes back faces both ways.
        """
        there = np.flatnonzero(self.poses.there[:, self.root])
        if self.poses.origins is None or not len(there):
            return None
        level = np.eye(3) - np.outer(self.up, self.up)
        ways = (self.poses.origins[there, self.root] - self.poses.origins[there[0], self.root]) @ level
        way, furthest = ways[-1], float(np.linalg.norm(ways, axis=1).max())
        axis = self.placed[self.root].rotation.as_matrix().T[:, 0]
        faced = level @ (self.poses.rotations[there, self.root] @ axis).mean(axis=0)
        if np.linalg.norm(way) < max(WALKED, 0.5 * furthest) or np.linalg.norm(faced) < UPRIGHT:
            return None
        return float(np.arccos(np.clip(way @ faced / (np.linalg.norm(way) * np.linalg.norm(faced)), -1.0, 1.0)))

    def weights(self, sizes: Mapping[str, float]) -> dict[str, float]:
        """Weights of the markers from those of orientations and origins."""
        found = {axis: sizes[name] for name in self.names for axis in axes_of(name)}
        return {**found, **{name: weight for name, weight in sizes.items() if name not in self.names}}


def axes_of(name: str) -> tuple[str, ...]:
    """Names of the three directions of a segment."""
    return tuple(f"{name}_{axis}" for axis in AXES)


def origin_of(name: str) -> str:
    """Name of a segment's origin."""
    return f"{name}_origin"


def segments_given(o: IkOptions, model: Multibody) -> Segments:
    """Segments of the recording that a body of the model belongs to, placed in it by the calibration."""
    whole = seen = _read(o, o.markers)
    if o.time is not None:
        part = seen.between(*o.time)
        if not len(part):
            what = f"no frame between {o.time[0]:g} and {o.time[1]:g} s"
            remedy = f"the recording is from {seen.time[0]:g} to {seen.time[-1]:g} s"
            raise InputError(seen.source, "`time`", what, remedy)
        seen = part
    bodies = _bodies(model, seen, o.markers_map)
    if not seen.of(tuple(bodies)).there.any():
        raise InputError(seen.source, "", "no frame shows any of these segments", "is it the right file?")
    still = seen
    if o.calibration is not None:
        _require_kind(o.calibration, o.markers)
        whole = still = _read(o, o.calibration)
        add_input("`calibration`", o.calibration, frames=len(still), segments=len(still.names))
        lost = [name for name in bodies if name not in still.names]
        if lost:
            what = f"{lost[0]} was not recorded"
            raise InputError(still.source, "`calibration`", what, f"there are {listed(still.names)}")
    names, own = tuple(bodies), tuple(bodies.values())
    still = still.of(names)
    shown = _first_whole(still)
    root = _root(model, own)
    placed = _placed(model, still, own, shown, root, o.heading)
    number = int(np.searchsorted(whole.time, still.time[shown])) + 1
    where = "the first frame" if number == 1 else f"frame {number} ({still.time[shown]:g} s)"
    where += "" if o.calibration is None else f" of {o.calibration.name}"
    where += ", the first that shows all segments," if shown else ""
    faces = "" if o.heading is not None else ", facing its x axis (else `heading`)"
    reserve(f"{where} places segments in bodies: the person is taken to stand as the model does by default{faces}")
    return Segments(seen.of(names), own, placed, np.asarray(model.up), root)


def _require_kind(calibration: Path, recording: Path) -> None:
    """InputError for a calibration of another kind of file: one has places of its segments, the other has none."""
    ending = recording.suffix.lower()
    if calibration.suffix.lower() != ending:
        what = f"is no {ending} file, which {recording.name} is"
        raise InputError(calibration, "`calibration`", what, "give a trial of the same system")


def _read(o: IkOptions, file: Path) -> SegmentPoses:
    seen = read_segments(file, o.c3d_unit)
    turn = turn_of(o.axes)
    return seen if turn is None else seen.turned(turn)


def _bodies(model: Multibody, seen: SegmentPoses, given: str | None) -> dict[str, str]:
    """Body of each segment that has one, by names or as `markers_map` says; a reservation lists both."""
    own = tuple(body.name for body in model.bodies)
    typed = _map(given)
    lost = [name for name in typed if name not in seen.names]
    foreign = [body for body in typed.values() if body not in own]
    for names, what, there in ((lost, "was not recorded", seen.names), (foreign, "is no body of the model", own)):
        if names:
            raise InputError(seen.source, "`markers_map`", f"{names[0]} {what}", f"there are {listed(there)}")
    found = {name: typed.get(name) or _body(name, own) for name in seen.names}
    used = {name: body for name, body in found.items() if body and body not in set(typed.values()) - {typed.get(name)}}
    if not used:
        what = f"no segment has the name of a body: {listed(seen.names)}"
        remedy = f"name them with `markers_map` l_thigh=femur_l; bodies are {listed(own)}"
        raise InputError(seen.source, "", what, remedy)
    unused = tuple(name for name in seen.names if name not in used)
    pairs = ", ".join(f"{name} for {body}" if name != body else name for name, body in used.items())
    reserve(f"{seen.source}: segments are taken for bodies: {pairs}{f'; not used: {listed(unused)}' if unused else ''}")
    return used


def _map(given: str | None) -> dict[str, str]:
    if given is None:
        return {}
    file = named_file(given)
    if file is None:
        return marker_map_typed(given, "`markers_map`")
    names = read_marker_map(file)
    add_input("`markers_map`", file, segments=len(names))
    return names


def _body(name: str, own: Sequence[str]) -> str:
    """Body of a segment or sensor by its name; empty where there is none."""
    stem = name.removesuffix(SENSOR)
    side, _, part = stem.partition("_") if stem[:2] in ("l_", "r_") else ("", "", stem)
    known = [f"{body}_{side}" if side else body for body in THEIA.get(part, ())]
    return next((body for body in (stem, *known) if body in own), "")


def _first_whole(still: SegmentPoses) -> int:
    """Number of the first frame that shows all segments; InputError where none does."""
    whole = np.flatnonzero(still.there.all(axis=1))
    if not len(whole):
        never = [name for name, seen in zip(still.names, np.asarray(still.there.any(axis=0)), strict=True) if not seen]
        what = f"no frame shows all segments{f'; {listed(tuple(never))} in none' if never else ''}"
        raise InputError(still.source, "", what, "give another `calibration`, or leave out with `markers_map`")
    return int(whole[0])


def _root(model: Multibody, bodies: tuple[str, ...]) -> int:
    """Number of the body that the fewest joints lead to from the ground, the first in the model's order of several."""
    parents = {joint.child: joint.parent for joint in model.joints}
    order = [body.name for body in model.bodies]

    def joints_to(body: str) -> int:
        count = 0
        while body in parents and count < len(order):
            body, count = parents[body], count + 1
        return count

    return min(range(len(bodies)), key=lambda k: (joints_to(bodies[k]), order.index(bodies[k])))


def _placed(
    model: Multibody, still: SegmentPoses, bodies: tuple[str, ...], shown: int, first: int, heading: str | None
) -> tuple[RigidTransform, ...]:
    """X_BS of each segment in the frame `shown`; origins count from that of the body `first`."""
    rotations = still.rotations[shown]
    rest = model.poses(model.coupled(np.array([[c.default for c in model.coordinates]])))
    frames = [rest[body][0] for body in bodies]
    turn = Rotation.identity() if heading is None else _heading(model, still, bodies, rotations, frames, heading)
    made = [frame.rotation.inv() * turn * Rotation.from_matrix(r) for frame, r in zip(frames, rotations, strict=True)]
    if still.origins is None:
        return tuple(RigidTransform.from_rotation(one) for one in made)
    places = turn.apply(still.origins[shown] - still.origins[shown, first]) + frames[first].translation
    reserve(
        f"the origin of {still.names[first]} is taken for that of {bodies[first]}: shifts of {bodies[first]} are its"
    )
    shifts = [frame.inv().apply(place) for frame, place in zip(frames, places, strict=True)]
    return tuple(RigidTransform.from_components(p, r) for p, r in zip(shifts, made, strict=True))


def _heading(
    model: Multibody,
    still: SegmentPoses,
    bodies: tuple[str, ...],
    rotations: Float[np.ndarray, "s 3 3"],
    frames: Sequence[RigidTransform],
    text: str,
) -> Rotation:
    """Turn about the vertical from the stated axis of a segment, pelvis_imu=-z, to the x axis of its body."""
    name, equals, axis = text.rpartition("=")
    sign, letter = axis[:-1], axis[-1:].lower()
    if not equals or letter not in tuple(AXES) or sign not in ("", "+", "-") or name not in still.names:
        what = f"'{text}' is no segment and its axis"
        raise InputError("", "`heading`", what, f"write pelvis_imu=-z; segments are {listed(still.names)}")
    k = still.names.index(name)
    level = np.eye(3) - np.outer(model.up, model.up)
    theirs = level @ rotations[k][:, AXES.index(letter)] * (-1.0 if sign == "-" else 1.0)
    ours = level @ frames[k].rotation.as_matrix()[:, 0]
    for size, what in ((theirs, f"axis {axis} of {name}"), (ours, f"the x axis of {bodies[k]}")):
        if np.linalg.norm(size) < UPRIGHT:
            raise InputError(still.source, "`heading`", f"{what} is upright in the calibration", "name another axis")
    return Rotation.from_rotvec(float(np.arctan2(model.up @ np.cross(theirs, ours), theirs @ ours)) * model.up)


ORIGINS = 3
"""Fewest origins that place a body without an orientation."""
UPRIGHT = 0.5
"""Level part of a unit vector below which it does not say where somebody faces: 60 degrees from level."""


def segment_tasks(model: Multibody, segments: Segments, o: IkOptions) -> MarkerTasks:
    """Weight 1 of every orientation and origin, or that of `weight`; coordinates of `hold`.

    InputError where fewer than one orientation or three origins have a weight.
    """
    sizes = dict.fromkeys(segments.sizes, 1.0)
    sizes |= weights_typed(o.weight, set(sizes), f"{segments.names[0]}=10")
    counted = [name for name, weight in sizes.items() if weight > 0.0]
    if len(counted) < ORIGINS and not set(counted) & set(segments.names):
        what = f"no orientation of a segment has a weight, and {len(counted) or 'no'} origins"
        raise InputError(o.markers, "`weight`", what, f"leave one orientation in, or {ORIGINS} origins")
    return MarkerTasks(segments.weights(sizes), held_near(model, o.hold))


def with_segments(model: Multibody, segments: Segments) -> Multibody:
    """The model with the directions and origins of its bodies in place of markers."""
    return replace(model, markers=segments.markers())

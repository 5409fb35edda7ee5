"""Both legs from a standing trial, with joint centres and axes of a functional trial where there is one.

The intact shank's frame has the knee's axis and points down to the ankle; the foot stands flat on the floor.

Centres by SCoRE, knee axes by SARA (`dynamics.functional_joint`); the study takes the methods of Schwartz & Rozumalski
(2005), of the same kind. Segments are taken to be where their markers are, which the standing trial gives all of.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.both_sides.amputee import LEGS, Amputee
from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.from_markers import (
    BODIES,
    INTACT_ANKLE,
    INTACT_BODIES,
    INTACT_FOOT,
    INTACT_KNEE,
    INTACT_STANDING,
    INTACT_TOES,
    KNEE,
    MAP,
    PELVIS,
    STANDING,
    along_y,
    along_z,
    hip_by_regression,
    knee_line,
    median_places,
    pelvis_frame,
    require_forward,
    require_length,
    require_lengths,
    require_spread,
    standing_leg,
)
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker
from geocontact.dynamics.functional_joint import Known, functional_axis, functional_centre, seen_together, segment_poses

Vector = Float[np.ndarray, " 3"]
SEGMENTS = {**BODIES, **{name: of for name, of in INTACT_BODIES.items() if name != "intact_toes"}}
LOOSE = 0.5
"""Looseness of a knee's axis (`FunctionalAxis`) from which on the knee hardly bends as a hinge."""
MOVE = "circle both hips, bend both knees, circle the ankle, with all markers in sight"


@dataclass(frozen=True, eq=False)
class JointLine:
    """Centre [m] and direction to the right of an axis, in the laboratory while standing; how far it is off itself [m].

    The middle of the epicondyles, moved onto the axis.
    """

    centre: Vector
    direction: Vector
    rms: float


@dataclass(frozen=True, eq=False)
class JointPoint:
    """Centre in the laboratory while standing [m], its standard error and how far it is off itself [m]."""

    centre: Vector
    sd: Vector
    rms: float


@dataclass(frozen=True, eq=False)
class FunctionalJoints:
    """What a functional trial tells; a joint that it does not move enough is missing, with the reason.

    Parameters
    ----------
    points
        `hip`, `intact_hip`, `intact_ankle`.
    lines
        `knee`, `intact_knee`.
    untold
        By the name of a joint.
    """

    points: dict[str, JointPoint] = field(default_factory=dict)
    lines: dict[str, JointLine] = field(default_factory=dict)
    untold: dict[str, str] = field(default_factory=dict)


POINTS = {
    "hip": ("pelvis", "thigh"),
    "intact_hip": ("pelvis", "intact_thigh"),
    "intact_ankle": ("intact_shank", "intact_foot"),
}
LINES = {"knee": ("thigh", "shank"), "intact_knee": ("intact_thigh", "intact_shank")}


def functional_joints(
    seen: MarkerTrajectories, standing: Mapping[str, Vector], middles: Mapping[str, tuple[Vector, Vector]]
) -> FunctionalJoints:
    """Centres and axes where markers stood.

    Parameters
    ----------
    seen
        The trial, as of a right prosthesis.
    standing
        Places of the markers while standing [m].
    middles
        Middle of the epicondyles and direction to the right by the name of a knee.

    InputError where a marker is missing.
    """
    names = [name for of in SEGMENTS.values() for name in of]
    missing = [name for name in names if name not in seen.names]
    if missing:
        raise InputError(seen.source, "`functional`", f"no marker {', '.join(missing)}", MAP)
    moved = {body: _poses(seen, of, standing) for body, of in SEGMENTS.items()}
    found = FunctionalJoints()
    for joint, pair in POINTS.items():
        one, other, _ = seen_together(*(moved[name] for name in pair))
        try:
            point = functional_centre(one, other)
        except ValueError as error:
            found.untold[joint] = str(error)
            continue
        found.points[joint] = JointPoint(point.first, point.first_sd, point.rms)
    for joint, pair in LINES.items():
        one, other, _ = seen_together(*(moved[name] for name in pair))
        try:
            line = functional_axis(one, other)
        except ValueError as error:
            found.untold[joint] = str(error)
            continue
        if line.looseness > LOOSE:
            found.untold[joint] = f"it turns about a point as well as about an axis (looseness {line.looseness:.2f})"
            continue
        middle, right = middles[joint]
        direction = line.first_direction * np.sign(line.first_direction @ right)
        onto = line.first + direction * (direction @ (middle - line.first))
        found.lines[joint] = JointLine(onto, direction, line.rms)
    return found


def _poses(seen: MarkerTrajectories, names: tuple[str, ...], standing: Mapping[str, Vector]) -> Known:
    """Poses in the frames that are known, against where the segment stood, and which frames those are."""
    try:
        poses, known, _ = segment_poses(seen.of(names), np.array([standing[name] for name in names]))
    except ValueError as error:
        raise InputError(seen.source, "`functional`", f"{', '.join(names)}: {error}", MOVE) from error
    return poses, known


FEET, ANKLES, HEIGHTS = (0.15, 0.40), (0.04, 0.14), (0.03, 0.2)
"""m; lengths of a foot, distances of malleoli and heights of the ankle that are plausible."""
NO_JOINTS = FunctionalJoints()


def standing_joints(standing: MarkerTrajectories, moving: MarkerTrajectories) -> FunctionalJoints:
    """Joint centres and axes of a functional trial, both trials as of a right prosthesis."""
    at = median_places(standing, (*STANDING, *INTACT_STANDING))
    lines = {"knee": knee_line(at, KNEE, 1.0), "intact_knee": knee_line(at, INTACT_KNEE, -1.0)}
    return functional_joints(moving, at, lines)


def standing_amputee(
    seen: MarkerTrajectories,
    person: Person,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    below: float,
    joints: FunctionalJoints = NO_JOINTS,
    stature: float | None = None,
) -> Amputee:
    """A person with a right prosthesis; InputError where the markers cannot tell both legs.

    Parameters
    ----------
    below
        From the sole of the prosthesis up to the keel's axis [m].
    joints
        Centres and axes that are known better than by regression and by epicondyles and malleoli.
    stature
        [m]; from the length of the intact leg by default.
    """
    at = median_places(seen, (*STANDING, *INTACT_STANDING))
    pelvis = pelvis_frame(at, seen.source)
    own = joints.points.get("hip")
    line = joints.lines.get("knee")
    prosthetic = standing_leg(
        seen,
        person,
        foot.keel,
        below,
        None if own is None else pelvis.inv().apply(own.centre),
        None if line is None else (line.centre, line.direction),
    )
    intact = _intact(seen, at, person, pelvis, joints)
    tall = (intact.thigh + intact.shank) / LEGS if stature is None else stature
    return Amputee(prosthetic, intact, tall, _upright(pelvis.rotation), foot, fulcrum)


def _upright(pelvis: Rotation) -> Rotation:
    """Axes of a pelvis in the laboratory (y up): components of who stands upright there into the pelvis' own."""
    up, across = np.array([0.0, 1.0, 0.0]), pelvis.apply([0.0, 0.0, 1.0]) * np.array([1.0, 0.0, 1.0])
    across = across / np.linalg.norm(across)
    return pelvis.inv() * Rotation.from_matrix(np.column_stack([np.cross(up, across), up, across]))


def standing_intact_leg(seen: MarkerTrajectories, person: Person) -> IntactLeg:
    """The intact leg alone of a person with a right prosthesis; InputError where the markers cannot tell it."""
    at = median_places(seen, (*PELVIS, *INTACT_STANDING))
    return _intact(seen, at, person, pelvis_frame(at, seen.source), NO_JOINTS)


def _intact(
    seen: MarkerTrajectories,
    at: Mapping[str, Vector],
    person: Person,
    pelvis: RigidTransform,
    joints: FunctionalJoints,
) -> IntactLeg:
    _require_side(seen, at)
    require_forward(seen, at, (INTACT_FOOT[0], INTACT_TOES[0]))
    point, line, turning = (
        joints.points.get("intact_hip"),
        joints.lines.get("intact_knee"),
        joints.points.get("intact_ankle"),
    )
    regression = hip_by_regression(dict(at)) * np.array([1.0, 1.0, -1.0])
    hip = regression if point is None else pelvis.inv().apply(point.centre)
    knee, across = knee_line(at, INTACT_KNEE, -1.0) if line is None else (line.centre, line.direction)
    ankle = 0.5 * (at[INTACT_ANKLE[0]] + at[INTACT_ANKLE[1]]) if turning is None else turning.centre
    centre = pelvis.apply(hip)
    thigh = along_y(centre, centre - knee, across)
    shank = along_z(knee, thigh.rotation.apply([0.0, 0.0, 1.0]), knee - ankle)
    foot = _foot_frame(at, ankle)
    heel, *heads = (foot.inv().apply(at[name]) for name in INTACT_FOOT)
    tip = foot.inv().apply(at[INTACT_TOES[0]])
    toes = RigidTransform.from_components(foot.apply(0.5 * (heads[0] + heads[1])), foot.rotation)
    frames = {"intact_thigh": thigh, "intact_shank": shank, "intact_foot": foot, "intact_toes": toes}
    markers = tuple(
        Marker(name, body, frames[body].inv().apply(at[name])) for body, of in INTACT_BODIES.items() for name in of
    )
    require_spread(seen, markers)
    radii = [0.5 * float(np.linalg.norm(at[one] - at[other])) for one, other in (INTACT_KNEE, INTACT_ANKLE)]
    leg = IntactLeg(
        person,
        hip,
        float(np.linalg.norm(centre - knee)),
        shank.inv().apply(ankle),
        radii[0],
        radii[1],
        heel,
        (heads[0], heads[1]),
        tip,
        float(ankle[1]),
        markers,
    )
    require_lengths(seen, leg.thigh, leg.shank, 2.0 * leg.knee_radius)
    for name, value, plausible in (
        ("intact foot", leg.length, FEET),
        ("intact ankle", 2.0 * leg.ankle_radius, ANKLES),
        ("height of the intact ankle", leg.sole, HEIGHTS),
    ):
        require_length(seen, name, value, plausible)
    if not leg.heel[0] < leg.toe_joint[0] < leg.hallux[0]:
        what = f"{INTACT_FOOT[0]}, {INTACT_FOOT[1]} and {INTACT_TOES[0]} do not follow each other along the foot"
        raise InputError(seen.source, "`static`", what, "are the markers named right?")
    return leg


def _foot_frame(at: Mapping[str, Vector], ankle: Vector) -> RigidTransform:
    """Origin in the ankle, x from the heel between the metatarsal heads along the floor, y up."""
    heel, first, fifth = (at[name] for name in INTACT_FOOT)
    forward = (0.5 * (first + fifth) - heel) * np.array([1.0, 0.0, 1.0])
    forward = forward / np.linalg.norm(forward)
    up = np.array([0.0, 1.0, 0.0])
    turn = Rotation.from_matrix(np.column_stack([forward, up, np.cross(forward, up)]))
    return RigidTransform.from_components(ankle, turn)


def _require_side(seen: MarkerTrajectories, at: Mapping[str, Vector]) -> None:
    """The intact leg on its own side, its outer markers outside, the first metatarsal inside."""
    right = at[PELVIS[0]] - at[PELVIS[1]]
    middle = 0.5 * (at[PELVIS[0]] + at[PELVIS[1]])
    knee = 0.5 * (at[INTACT_KNEE[0]] + at[INTACT_KNEE[1]])
    pairs = (INTACT_KNEE, INTACT_ANKLE, (INTACT_FOOT[2], INTACT_FOOT[1]))
    wrong = [outer for outer, inner in pairs if (at[outer] - at[inner]) @ right >= 0.0]
    if (knee - middle) @ right >= 0.0:
        wrong = ["the leg"]
    if wrong:
        what = f"left and right are exchanged on the intact side: {wrong[0]} lies on the wrong side"
        raise InputError(seen.source, "`static`", what, "is `side` right? else rename with `markers_map`")

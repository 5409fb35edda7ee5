"""A person who stands: markers, joints of a functional trial, both legs made to measure, and the pose that was seen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.prosthesis.recorded_files import right_markers
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.standing import NO_JOINTS, FunctionalJoints, standing_joints
from geocontact.below_knee_prosthesis.from_markers import as_right
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot, fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of

MOVED = 0.02
"""m that a marker may move while standing without a word."""


@dataclass(frozen=True, eq=False)
class Stood:
    """Markers of a person who stands, as of a right prosthesis, and what is known beside them."""

    seen: MarkerTrajectories
    moving: MarkerTrajectories | None
    joints: FunctionalJoints
    person: Person
    foot: VariableStiffnessFoot
    fulcrum: float


def read(o: ProsthesisScaleOptions) -> Stood:
    """Everything the options name."""
    seen = right_markers("static", o.static, o.side, o.axes, o.markers_map, o.c3d_unit)
    _warn_of_motion(seen)
    moving = None
    if o.functional is not None:
        moving = right_markers("`functional`", o.functional, o.side, o.axes, o.markers_map, o.c3d_unit)
    joints = NO_JOINTS if moving is None else standing_joints(seen, moving)
    foot = vsf_foot()
    keel = foot.keel.posterior_mass + foot.keel.joints * foot.keel.segment_mass
    mass = cast(float, o.mass)
    person = Person(mass, o.sex, o.residual)
    if o.prosthesis_mass is not None:
        if o.prosthesis_mass <= keel:
            what = f"{o.prosthesis_mass:g} kg are less than the keel alone, {keel:.2f} kg"
            raise InputError("", "`prosthesis_mass`", what, "give that of socket, pylon and foot")
        person = Person(mass, o.sex, o.residual, o.prosthesis_mass - keel)
    fulcrum = fulcrum_of(o.setting, "pinned") if o.fulcrum is None else o.fulcrum
    return Stood(seen, moving, joints, person, foot, fulcrum)


def _warn_of_motion(seen: MarkerTrajectories) -> None:
    off = np.linalg.norm(seen.positions - np.nanmedian(seen.positions, axis=0), axis=2)
    far = np.nanmax(off, axis=0)
    if np.nanmax(far) > MOVED:
        name = seen.names[int(np.nanargmax(far))]
        what = f"{name} moves {1e3 * np.nanmax(far):.0f} mm away from its median: is this standing still?"
        reserve(f"{seen.source}: {what}")


@dataclass(frozen=True)
class JointFound:
    """A joint of a person who stands.

    Parameters
    ----------
    how
        Its centre was found.
    place
        In the laboratory [m].
    rms
        How far both segments put it apart [m]; None where no functional trial tells it.
    """

    name: str
    how: str
    place: Float[np.ndarray, " 3"]
    rms: float | None


LEGS, USUAL = (0.36, 0.62), (0.44, 0.54)
"""Thigh and shank over the height: what is refused beyond, and what is usual (Drillis & Contini 1966: 0.491)."""
EVEN = 0.1
"""Relative difference of both thighs, or of both shanks, from which on it is a reservation."""
FAR = 0.015
"""m by which a functional joint may be off itself without a word."""
JOINTS = {
    "hip": ("hip", "regression"),
    "intact_hip": ("intact hip", "regression"),
    "knee": ("knee", "middle of the epicondyles"),
    "intact_knee": ("intact knee", "middle of the epicondyles"),
    "intact_ankle": ("intact ankle", "middle of the malleoli"),
}


def standing_pose(held: Multibody, stood: Stood, o: ProsthesisScaleOptions) -> Poses:
    """Pose of the standing trial; its markers are where the model has them, for it was made of them."""
    pose = fitted_pose(held, _mean(stood, o))
    if not pose.settled.all():
        raise InputError(o.static, "", "no pose of the model fits the markers", "are the markers named right?")
    return pose


def _mean(stood: Stood, o: ProsthesisScaleOptions) -> MarkerTrajectories:
    """One frame, in the laboratory of the person's own side."""
    seen = as_right(stood.seen, o.side)
    return MarkerTrajectories(seen.time[:1], np.nanmedian(seen.positions, axis=0)[None], seen.names, seen.source)


def fitted_pose(held: Multibody, seen: MarkerTrajectories) -> Poses:
    """Poses of the model whose markers are nearest to those that were seen; InputError where markers are missing."""
    try:
        return inverse_kinematics(tree_of(held), seen, MarkerTasks(dict.fromkeys((m.name for m in held.markers), 1.0)))
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "are the markers named right?") from error


def as_standing(model: Multibody, pose: Poses) -> Multibody:
    """The standing pose as the defaults of the coordinates that markers tell."""
    at = dict(zip(pose.names, np.asarray(pose.values)[0].tolist(), strict=True))
    joints = tuple(
        replace(joint, coordinates=tuple(replace(c, default=at.get(c.name, 0.0)) for c in joint.coordinates))
        for joint in model.joints
    )
    return replace(model, joints=joints)


def joint_centres(
    stood: Stood, made: Amputee, held: Multibody, pose: Poses, o: ProsthesisScaleOptions
) -> tuple[JointFound, ...]:
    """Centres in the laboratory, of the person's own side."""
    own, other = ("_r", "_l") if o.side == "right" else ("_l", "_r")
    bodies = {
        "hip": f"femur{own}",
        "intact_hip": f"femur{other}",
        "knee": f"tibia{own}",
        "intact_knee": f"tibia{other}",
        "intact_ankle": f"calcn{other}",
    }
    poses = held.poses(pose.values)
    found = []
    for name, (shown, usual) in JOINTS.items():
        place = poses[bodies[name]].translation[0]
        point, line = stood.joints.points.get(name), stood.joints.lines.get(name)
        known = point or line
        how = usual if known is None else "functional"
        found.append(JointFound(shown, how, place, None if known is None else known.rms))
    return tuple(found)


def warn_of_legs(made: Amputee, stood: Stood, o: ProsthesisScaleOptions) -> None:
    """Reservations on lengths and joints of the legs; InputError for legs that no person of that height has."""
    own, intact = made.prosthetic, made.intact
    if o.height is not None:
        share = (intact.thigh + intact.shank) / o.height
        if not LEGS[0] <= share <= LEGS[1]:
            what = f"thigh and shank would be {share:.0%} of a height of {o.height:g} m"
            raise InputError(o.static, "`height`", what, "check `height` and the unit of the markers")
        if not USUAL[0] <= share <= USUAL[1]:
            reserve(f"thigh and shank are {share:.1%} of the height; {USUAL[0]:.0%} to {USUAL[1]:.0%} are usual")
    for name, one, two in (("thigh", own.thigh, intact.thigh), ("shank", own.shank, intact.shank)):
        if abs(one / two - 1.0) > EVEN:
            reserve(f"the {name} measures {one:.3f} m on the prosthetic and {two:.3f} m on the intact side")
    if o.functional is None:
        reserve("hips by regression, knees and ankle by their markers; a `functional` trial tells them better")
    for name, why in stood.joints.untold.items():
        reserve(f"the functional trial does not tell the {JOINTS[name][0]}: {why}")
    points, lines = stood.joints.points, stood.joints.lines
    apart = {name: each.rms for name, each in points.items()} | {name: each.rms for name, each in lines.items()}
    for name, rms in apart.items():
        if rms > FAR:
            reserve(f"{JOINTS[name][0]}: both segments put it {1e3 * rms:.0f} mm apart: is the skin loose?")

"""Both legs of a person, their joints, and the pose in which the markers were seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.motion.marker_errors import MOVING, MarkerErrors
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.read import Stood
from geocontact.analyses.prosthesis.scale.result import JointFound, ProsthesisScaleResult
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import standing_amputee
from geocontact.below_knee_prosthesis.from_markers.sides import as_right
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_tasks import MarkerTasks
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of

LEGS, USUAL = (0.36, 0.62), (0.44, 0.54)
"""Thigh and shank over the height: what is refused beyond, and what is usual (Drillis & Contini 1966: 0.491)."""
EVEN = 0.1
"""Relative difference of both thighs, or of both shanks, from which on it is told."""
FAR = 0.015
"""m by which a functional joint may be off itself without a word."""
JOINTS = {
    "hip": ("hip", "regression"),
    "intact_hip": ("intact hip", "regression"),
    "knee": ("knee", "middle of the epicondyles"),
    "intact_knee": ("intact knee", "middle of the epicondyles"),
    "intact_ankle": ("intact ankle", "middle of the malleoli"),
}


def run(stood: Stood, o: ProsthesisScaleOptions, record: Record) -> ProsthesisScaleResult:
    """The model, its joints and its standing pose."""
    below = sole_numbers()["below"].value
    made = standing_amputee(stood.seen, stood.person, stood.foot, stood.fulcrum, below, stood.joints, o.height)
    mass = made.pelvis_body()[0]
    if not mass > 0.0:
        what = f"the legs leave {mass:.1f} kg of {made.mass:g} kg for all above them"
        raise InputError("", "`mass`", what, "check `mass` and `prosthesis_mass`")
    held = amputee_tree(made, o.side, held=True)
    pose = _pose(held, stood, o)
    moved = None if stood.moving is None else _fitted(held, as_right(stood.moving, o.side))
    joints = _joints(stood, made, held, pose, o)
    numbers = made.numbers()
    _doubt(made, stood, o, record)
    invented = sum(number.source == "invented" for number in numbers.values())
    record.warn(f"{invented} of {len(numbers)} numbers of the segments are invented, see numbers.csv")
    told = [joint.how == "functional" for joint in joints]
    record.say(
        f"both legs of {made.mass:g} kg in {len(held.bodies)} bodies with {len(held.coordinates)} coordinates, "
        f"pelvis with all above it {mass:.1f} kg, residual limb {made.prosthetic.residual_body()[0]:.2f} kg"
    )
    record.say(f"{sum(told)} of {len(told)} joint centres from the functional trial")
    if moved is not None:
        errors = MarkerErrors.of(moved)
        errors.warn(record, MOVING)
        record.say(f"markers of the functional trial {errors.words(MOVING)}")
    record.results["scale"] = plain(
        {
            "mass_kg": held.mass,
            "pelvis_kg": mass,
            "residual_kg": made.prosthetic.residual_body()[0],
            "density_kg_per_m3": made.intact.density,
            "joints_off_themselves_mm": {joint.name: 1e3 * joint.rms for joint in joints if joint.rms is not None},
            "functional_rms_mm": None if moved is None else 1e3 * float(np.sqrt(np.nanmean(moved.distances**2))),
        }
    )
    return ProsthesisScaleResult(
        record=record,
        options=o,
        amputee=made,
        model=_standing(amputee_tree(made, o.side), pose),
        held=_standing(held, pose),
        pose=pose,
        moved=moved,
        joints=joints,
        numbers=numbers,
    )


def _mean(stood: Stood, o: ProsthesisScaleOptions) -> MarkerTrajectories:
    """One frame, in the laboratory of the person's own side."""
    seen = as_right(stood.seen, o.side)
    return MarkerTrajectories(seen.time[:1], np.nanmedian(seen.positions, axis=0)[None], seen.names, seen.source)


def _pose(held: Multibody, stood: Stood, o: ProsthesisScaleOptions) -> Poses:
    """Of the standing trial; its markers are where the model has them, for it was made of them."""
    pose = _fitted(held, _mean(stood, o))
    if not pose.settled.all():
        raise InputError(o.static, "", "no pose of the model fits the markers", "are the markers named right?")
    return pose


def _fitted(held: Multibody, seen: MarkerTrajectories) -> Poses:
    try:
        return inverse_kinematics(tree_of(held), seen, MarkerTasks(dict.fromkeys((m.name for m in held.markers), 1.0)))
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "are the markers named right?") from error


def _standing(model: Multibody, pose: Poses) -> Multibody:
    """The standing pose as the defaults of the coordinates that markers tell."""
    at = dict(zip(pose.names, np.asarray(pose.values)[0].tolist(), strict=True))
    joints = tuple(
        replace(joint, coordinates=tuple(replace(c, default=at.get(c.name, 0.0)) for c in joint.coordinates))
        for joint in model.joints
    )
    return replace(model, joints=joints)


def _joints(
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


def _doubt(made: Amputee, stood: Stood, o: ProsthesisScaleOptions, record: Record) -> None:
    own, intact = made.prosthetic, made.intact
    if o.height is not None:
        share = (intact.thigh + intact.shank) / o.height
        if not LEGS[0] <= share <= LEGS[1]:
            what = f"thigh and shank would be {share:.0%} of a height of {o.height:g} m"
            raise InputError(o.static, "`height`", what, "check `height` and the unit of the markers")
        if not USUAL[0] <= share <= USUAL[1]:
            record.warn(f"thigh and shank are {share:.1%} of the height; {USUAL[0]:.0%} to {USUAL[1]:.0%} are usual")
    for name, one, two in (("thigh", own.thigh, intact.thigh), ("shank", own.shank, intact.shank)):
        if abs(one / two - 1.0) > EVEN:
            record.warn(f"the {name} measures {one:.3f} m on the prosthetic and {two:.3f} m on the intact side")
    if o.functional is None:
        record.warn("hips by regression, knees and ankle by their markers; a `functional` trial tells them better")
    for name, why in stood.joints.untold.items():
        record.warn(f"the functional trial does not tell the {JOINTS[name][0]}: {why}")
    points, lines = stood.joints.points, stood.joints.lines
    apart = {name: each.rms for name, each in points.items()} | {name: each.rms for name, each in lines.items()}
    for name, rms in apart.items():
        if rms > FAR:
            record.warn(f"{JOINTS[name][0]}: both segments put it {1e3 * rms:.0f} mm apart: is the skin loose?")

"""A person who stands, as a model of both legs: its standing pose, where its joints are, and what speaks against it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.standing import FunctionalJoints
from geocontact.below_knee_prosthesis.from_markers import as_right
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.loads.sphere_set import SphereSet

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
"""In words, and how each is found without a functional trial."""


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


def largest_motion(seen: MarkerTrajectories) -> tuple[str, float]:
    """The marker that moves farthest from its median place, and how far [m]: a person who stands still has little."""
    off = np.linalg.norm(seen.positions - np.nanmedian(seen.positions, axis=0), axis=2)
    far = np.nanmax(off, axis=0)
    return seen.names[int(np.nanargmax(far))], float(np.nanmax(far))


def model_poses(model: Multibody, seen: MarkerTrajectories) -> Poses:
    """Poses of the model whose markers are nearest to those that were seen, all of one weight.

    InputError where markers are missing.
    """
    try:
        return inverse_kinematics(
            tree_of(model), seen, MarkerTasks(dict.fromkeys((m.name for m in model.markers), 1.0))
        )
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "are the markers named right?") from error


def standing_pose(model: Multibody, seen: MarkerTrajectories, side: Side) -> Poses:
    """The pose of a standing trial; its markers are where the model has them, for it was made of them.

    Parameters
    ----------
    model
        With socket and keel held (`amputee_tree`), of the person's own side.
    seen
        As of a right prosthesis.

    InputError where markers are missing or no pose fits them.
    """
    own = as_right(seen, side)  # the mirror image of a mirror image: in the laboratory
    median = np.nanmedian(own.positions, axis=0)[None]
    pose = model_poses(model, MarkerTrajectories(own.time[:1], median, own.names, own.source))
    if not pose.settled.all():
        raise InputError(seen.source, "", "no pose of the model fits the markers", "are the markers named right?")
    return pose


def as_standing(model: Multibody, pose: Poses) -> Multibody:
    """The model with the first pose as the defaults of its coordinates; 0 for those that the pose does not have."""
    at = dict(zip(pose.names, np.asarray(pose.values)[0].tolist(), strict=True))
    joints = tuple(
        replace(joint, coordinates=tuple(replace(c, default=at.get(c.name, 0.0)) for c in joint.coordinates))
        for joint in model.joints
    )
    return replace(model, joints=joints)


def joint_centres(model: Multibody, pose: Poses, joints: FunctionalJoints, side: Side) -> tuple[JointFound, ...]:
    """Centres in the laboratory, of the person's own side, and how each was found.

    Parameters
    ----------
    model, pose
        Of the person's own side, and while standing.
    joints
        Of the functional trial that the model was made with; `NO_JOINTS` without one.
    """
    own, other = ("_r", "_l") if side == "right" else ("_l", "_r")
    bodies = {
        "hip": f"femur{own}",
        "intact_hip": f"femur{other}",
        "knee": f"tibia{own}",
        "intact_knee": f"tibia{other}",
        "intact_ankle": f"calcn{other}",
    }
    poses = model.poses(pose.values)
    found = []
    for name, (shown, usual) in JOINTS.items():
        known = joints.points.get(name) or joints.lines.get(name)
        how, rms = (usual, None) if known is None else ("functional", known.rms)
        found.append(JointFound(shown, how, poses[bodies[name]].translation[0], rms))
    return tuple(found)


def doubts_of_legs(made: Amputee, joints: FunctionalJoints, height: float | None, source: str) -> list[str]:
    """Reasons to doubt the lengths of both legs, each in a sentence; InputError for legs that no such person has.

    Parameters
    ----------
    height
        Of the person [m]; None where it is not known.
    source
        Where the markers are from: what an error names.
    """
    said, own, intact = [], made.prosthetic, made.intact
    if height is not None:
        share = (intact.thigh + intact.shank) / height
        if not LEGS[0] <= share <= LEGS[1]:
            what = f"thigh and shank would be {share:.0%} of a height of {height:g} m"
            raise InputError(source, "`height`", what, "check `height` and the unit of the markers")
        if not USUAL[0] <= share <= USUAL[1]:
            said.append(f"thigh and shank are {share:.1%} of the height; {USUAL[0]:.0%} to {USUAL[1]:.0%} are usual")
    for name, one, two in (("thigh", own.thigh, intact.thigh), ("shank", own.shank, intact.shank)):
        if abs(one / two - 1.0) > EVEN:
            said.append(f"the {name} measures {one:.3f} m on the prosthetic and {two:.3f} m on the intact side")
    if not (joints.points or joints.lines or joints.untold):
        said.append("hips by regression, knees and ankle by their markers; a `functional` trial determines them better")
    return [*said, *doubts_of_joints(joints)]


def doubts_of_joints(joints: FunctionalJoints) -> list[str]:
    """Joints that a functional trial does not tell, with the reason, and those that both segments put apart."""
    said = [
        f"the functional trial does not determine the {JOINTS[name][0]}: {why}" for name, why in joints.untold.items()
    ]
    apart = {name: each.rms for name, each in joints.points.items()}
    apart |= {name: each.rms for name, each in joints.lines.items()}
    for name, rms in apart.items():
        if rms > FAR:
            said.append(f"{JOINTS[name][0]}: both segments put it {1e3 * rms:.0f} mm apart: is the skin loose?")
    return said


def sole_spheres(made: Amputee, side: Side) -> list[tuple[str, SphereSet]]:
    """Spheres of both soles by the body that carries them, in its frame as of a right prosthesis.

    Bodies are called as in `amputee_tree` of that side; one that carries none is left out.
    """
    keel, sole = made.foot.keel, made.foot.sole
    own, other = ("_r", "_l") if side == "right" else ("_l", "_r")
    sets = [(f"keel_{k}{own}" if k else f"calcn{own}", sole.on(k, keel)) for k in range(keel.joints + 1)]
    sets += list(zip((f"calcn{other}", f"toes{other}"), made.intact.spheres(), strict=True))
    return [(body, spheres) for body, spheres in sets if spheres is not None]

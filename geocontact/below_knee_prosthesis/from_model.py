"""The prosthetic leg of a model of both legs: its markers along given coordinates, and its joints in a standing trial.

A model that `geocontact prosthesis scale` makes has the markers of `from_markers.BODIES` on pelvis, thigh and socket.
Where its coordinates are known, these markers stand for the recorded ones: they are where the three bodies are, so that
hip, knee and socket of `recorded_tree` follow from them without a remainder. The hip's centre and the knee's axis are
the model's, found in the standing trial by the markers of pelvis and thigh (least squares of both clusters, Arun, Huang
& Blostein 1987).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.from_markers import (
    BODIES,
    FOOT,
    KNEE,
    MIRROR,
    PELVIS,
    Vector,
    median_places,
    mirrored_name,
    pelvis_frame,
)
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.data.errors import InputError
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.functional_joint import segment_poses

SCALED = "give the model that `prosthesis scale` leaves, such as amputee_ik.osim; is `side` right?"
"""What helps where a model has other markers or joints."""


@dataclass(frozen=True, eq=False)
class ModelLeg:
    """Joints of a model's prosthetic leg in a standing trial, as of a right leg.

    Parameters
    ----------
    hip
        Centre in the pelvis' frame [m].
    knee
        Centre in the laboratory [m].
    across
        Direction of the axis that the knee turns about first, in the laboratory, to the right.
    off
        Distance of the standing markers of pelvis and thigh from the model's, root mean square [m].
    """

    hip: Vector
    knee: Vector
    across: Vector
    off: float


def model_markers(
    model: Multibody, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], side: Side, source: str
) -> MarkerTrajectories:
    """Markers of pelvis, thigh and socket where coordinates [rad, m] put them, in the ground's frame, by the person's
    own names.

    InputError where the model has not all of them.
    """
    names = [_own(name, side) for of in BODIES.values() for name in of]
    columns = _columns(model, names, source)
    return MarkerTrajectories(time, model.marker_places(values)[:, columns], tuple(names), source)


def model_leg(model: Multibody, standing: MarkerTrajectories, side: Side, source: str) -> ModelLeg:
    """Hip and knee of a model in a standing trial, which is as of a right prosthesis.

    InputError where the model has no such markers or joints.
    """
    at = median_places(standing, (*PELVIS, *BODIES["thigh"], *KNEE))
    pelvis, thigh = (_body_of(model, BODIES[body], side, source) for body in ("pelvis", "thigh"))
    hip, knee = _joint_below(model, pelvis, thigh, source), _joint_below(model, thigh, None, source)
    places = [_placed(model, BODIES[body], at, side, source) for body in ("pelvis", "thigh")]
    (in_pelvis, off_pelvis), (in_thigh, off_thigh) = places
    centre = in_pelvis.apply(_as_right(hip.parent_offset.translation, side))
    axis = in_thigh.rotation.apply(_as_right(knee.parent_offset.rotation.apply(knee.axes[0].direction), side))
    right = at[KNEE[0]] - at[KNEE[1]]
    return ModelLeg(
        pelvis_frame(at, standing.source).inv().apply(centre),
        in_thigh.apply(_as_right(knee.parent_offset.translation, side)),
        axis * np.sign(axis @ right),
        float(np.sqrt(0.5 * (off_pelvis**2 + off_thigh**2))),
    )


def with_toe(seen: MarkerTrajectories, standing: MarkerTrajectories, side: Side) -> MarkerTrajectories:
    """Markers of a model with that over the keel's tip, where it was on the socket while standing.

    A keel that does not bend: enough to see whether foot and floor are at one height. `seen` and `standing` are of the
    person's own side.
    """
    toe, names = _own(FOOT[1], side), tuple(_own(name, side) for name in BODIES["shank"])
    places = np.nanmedian(standing.of((*names, toe)), axis=0)
    poses, known, _ = segment_poses(seen.of(names), places[:-1])
    tip = np.full((len(seen), 1, 3), np.nan)
    tip[known, 0] = poses.apply(places[-1])
    return MarkerTrajectories(seen.time, np.concatenate([seen.positions, tip], 1), (*seen.names, toe), seen.source)


def marker_distances(one: MarkerTrajectories, other: MarkerTrajectories) -> dict[str, Float[np.ndarray, " t"]]:
    """Distance between markers that both have [m], at the times of the second that the first covers; NaN where one is
    not seen.
    """
    known = (other.time >= one.time[0]) & (other.time <= one.time[-1])
    found = {}
    for name in (each for each in one.names if each in other.names):
        mine, seen = (of.positions[:, of.names.index(name)] for of in (one, other))
        there = np.column_stack([np.interp(other.time[known], one.time, column) for column in mine.T])
        found[name] = np.linalg.norm(there - seen[known], axis=1)
    return found


def _own(name: str, side: Side) -> str:
    return name if side == "right" else mirrored_name(name)


def _as_right(vector: Vector, side: Side) -> Vector:
    return vector if side == "right" else vector * MIRROR


def _columns(model: Multibody, names: Sequence[str], source: str) -> list[int]:
    known = [m.name for m in model.markers]
    missing = [name for name in names if name not in known]
    if missing:
        raise InputError(source, "`model`", f"has no marker {', '.join(missing)}", SCALED)
    return [known.index(name) for name in names]


def _body_of(model: Multibody, names: Sequence[str], side: Side, source: str) -> str:
    """The body that carries markers; InputError where these are on several."""
    own = [_own(name, side) for name in names]
    bodies = list(dict.fromkeys(model.markers[k].body for k in _columns(model, own, source)))
    if len(bodies) > 1:
        raise InputError(source, "`model`", f"markers {', '.join(own)} are on {' and '.join(bodies)}", SCALED)
    return bodies[0]


def _joint_below(model: Multibody, parent: str, child: str | None, source: str) -> JointModel:
    """The joint from one body to another, or to the only one below it."""
    found = [j for j in model.joints if j.parent == parent and child in (None, j.child)]
    if len(found) != 1:
        below = child or "one body"
        raise InputError(source, "`model`", f"{len(found)} joints lead from {parent} to {below}", SCALED)
    return found[0]


def _placed(
    model: Multibody, names: Sequence[str], at: dict[str, Vector], side: Side, source: str
) -> tuple[RigidTransform, float]:
    """Pose of a body in the laboratory by its markers while standing, and their distance from it [m]."""
    columns = _columns(model, [_own(name, side) for name in names], source)
    template = np.array([_as_right(model.markers[k].location, side) for k in columns])
    poses, _, off = segment_poses(np.array([[at[name] for name in names]]), template)
    return poses[0], float(off[0])

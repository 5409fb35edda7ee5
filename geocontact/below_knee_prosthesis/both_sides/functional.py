"""Joint centres and axes from a trial in which hips, knees and the intact ankle move, and a standing one.

Centres by SCoRE, knee axes by SARA (`dynamics.functional_joint`); the study takes the methods of Schwartz & Rozumalski
(2005), of the same kind. Segments are taken to be where their markers are, which the standing trial gives all of.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.from_markers.marker_names import BODIES, INTACT_BODIES, MAP
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.dynamics.functional_joint import functional_axis, functional_centre
from geocontact.dynamics.segment_poses import Known, seen_together, segment_poses

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

"""Centre or axis of a joint from how two segments move against each other.

SCoRE: Ehrig, Taylor, Duda & Heller (2006), A survey of formal methods for determining the centre of rotation of ball
joints, J Biomech 39, 2798-2809. SARA: the same authors (2007), A survey of formal methods for determining functional
joint axes, J Biomech 40, 2150-2157. Both solve R1 c1 + t1 = R2 c2 + t2 for the point in both segments; with an axis
every point of it does, and the direction is what the matrix [R1, -R2] takes to nothing.

`functional_joint` finds the centre (SCoRE) or axis (SARA); here the two come as points that move with either segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.register.landmarks import fitted_pose, fix_a_pose

FEWEST = 3
"""Markers that fix a pose."""


Known = tuple[RigidTransform, Bool[np.ndarray, " t"]]
"""Poses in the frames that are known, and which of all frames those are."""


def seen_together(one: Known, other: Known) -> tuple[RigidTransform, RigidTransform, Bool[np.ndarray, " t"]]:
    """Poses of two segments in the frames that tell both, and which frames those are."""
    (first, known), (second, known_too) = one, other
    both = known & known_too
    return first[both[known]], second[both[known_too]], both


def segment_poses(
    places: Float[np.ndarray, "t m 3"], template: Float[np.ndarray, "m 3"] | None = None
) -> tuple[RigidTransform, Bool[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Poses of the template in the ground in the frames that tell them, which those are, how far markers are off [m].

    Parameters
    ----------
    places
        Of the markers [m], NaN where one was not seen.
    template
        Their places in the segment's frame; the first frame that shows all of them, about their mean, by default.

    The distance is the root mean square over the markers that were seen, NaN in frames that are not known: those with
    fewer than three.
    ValueError where no frame shows all markers and no template is given, or the markers lie on a line.
    """
    seen = np.isfinite(places).all(axis=2)
    if template is None:
        whole = np.flatnonzero(seen.all(axis=1))
        if not len(whole):
            raise ValueError("no frame shows all markers of the segment; give a template")
        template = places[whole[0]] - places[whole[0]].mean(axis=0)
    known = seen.sum(axis=1) >= FEWEST
    if not known.any():
        raise ValueError(f"no frame shows {FEWEST} markers of the segment")
    matrices, off, checked = [], np.full(len(places), np.nan), set[bytes]()
    for frame in np.flatnonzero(known):
        there = seen[frame]
        own, at = template[there], places[frame, there]
        if there.tobytes() not in checked:
            fix_a_pose(own, "moving")
            checked.add(there.tobytes())
        fix_a_pose(at, "fixed")
        pose = fitted_pose(own, at, np.ones(len(own)))
        matrices.append(pose.as_matrix())
        off[frame] = np.sqrt(np.mean(np.sum((pose.apply(own) - at) ** 2, axis=1)))
    return RigidTransform.from_matrix(np.array(matrices)), known, off


Vector = Float[np.ndarray, " 3"]
LEAST = np.radians(5.0)
"""Turn of one segment against the other [rad] below which nothing is said."""
TILTED = 0.06
"""Root mean square by which the common line is out of itself [rad]; 3 mm of noise on a cluster of 5 cm makes 0.04."""


@dataclass(frozen=True)
class FunctionalCentre:
    """A point that both segments share.

    Parameters
    ----------
    first, second
        In the frames of both segments [m].
    first_sd, second_sd
        Standard errors [m], for errors without memory: smooth errors of skin make them larger.
    rms
        Distance of the two in the ground [m], root mean square over the frames.
    """

    first: Vector
    second: Vector
    first_sd: Vector
    second_sd: Vector
    rms: float


@dataclass(frozen=True)
class FunctionalAxis:
    """A line that both segments share.

    Parameters
    ----------
    first, second
        The point of it nearest to the first segment's origin, in the frames of both [m].
    first_direction, second_direction
        Unit vectors along it in both.
    rms
        Distance of the two points in the ground [m], root mean square over the frames.
    looseness
        Smallest over second smallest singular value: 0 for a hinge, 1 where a point fits as well as an axis.
    """

    first: Vector
    second: Vector
    first_direction: Vector
    second_direction: Vector
    rms: float
    looseness: float


def functional_centre(first: RigidTransform, second: RigidTransform) -> FunctionalCentre:
    """Symmetrical centre of rotation (SCoRE) from poses of both segments in one frame, the same times.

    ValueError where they turn against each other by less than `LEAST`, or about one axis only: where points a metre
    apart along it move less than `TILTED` metres against each other, which noise of the turns does as well.
    """
    matrix, right = _system(first, second)
    values = np.linalg.svd(matrix, compute_uv=False)
    tilted = values[-1] / np.sqrt(len(right) / 3)
    if tilted < TILTED:
        what = f"{tilted:.2g} per metre along it"
        raise ValueError(f"the segments turn about one axis: points of it hardly differ ({what})")
    found, *_ = np.linalg.lstsq(matrix, right, rcond=None)
    left = matrix @ found - right
    variance = left @ left / max(len(right) - 6, 1)
    spread = np.sqrt(variance * np.diag(np.linalg.inv(matrix.T @ matrix)))
    return FunctionalCentre(found[:3], found[3:], spread[:3], spread[3:], _rms(left))


def functional_axis(first: RigidTransform, second: RigidTransform) -> FunctionalAxis:
    """Symmetrical axis of rotation (SARA) from poses of both segments in one frame, the same times.

    The direction points to the larger part of its largest component in the first segment. ValueError where they turn
    against each other by less than `LEAST`.
    """
    matrix, right = _system(first, second)
    left, values, rows = np.linalg.svd(matrix, full_matrices=False)
    found = rows[:5].T @ ((left[:, :5].T @ right) / values[:5])
    along = rows[5]
    along = along * np.sign(along[np.argmax(np.abs(along[:3]))])
    along = along / np.linalg.norm(along[:3])
    found = found - (found[:3] @ along[:3]) * along
    direction = along[3:] / np.linalg.norm(along[3:])
    off = matrix @ found - right
    return FunctionalAxis(found[:3], found[3:], along[:3], direction, _rms(off), float(values[5] / values[4]))


def _system(first: RigidTransform, second: RigidTransform) -> tuple[Float[np.ndarray, "r 6"], Float[np.ndarray, " r"]]:
    turned = (first.rotation.inv() * second.rotation).as_matrix()
    away = np.arccos(np.clip((np.einsum("tij,ij->t", turned, turned[0]) - 1.0) / 2.0, -1.0, 1.0))
    if away.max() < LEAST:
        raise ValueError(f"the segments turn against each other by {np.degrees(away.max()):.2g} deg only")
    matrix = np.concatenate([first.rotation.as_matrix(), -second.rotation.as_matrix()], axis=2).reshape(-1, 6)
    return matrix, (second.translation - first.translation).ravel()


def _rms(left: Float[np.ndarray, " r"]) -> float:
    return float(np.sqrt(np.mean(np.sum(left.reshape(-1, 3) ** 2, axis=1))))


HALF = 0.05
"""m along an axis from its middle to either point."""


@dataclass(frozen=True, eq=False)
class JointPoints:
    """Points of a joint.

    Parameters
    ----------
    first, second
        One of a centre, two of an axis, in the frames of both segments [m].
    first_sd, second_sd
        Standard errors of a centre [m], for errors without memory; None of an axis.
    rms
        Distance of what both segments say, in the ground [m], root mean square over the frames.
    looseness
        Of an axis (`FunctionalAxis`); None of a centre.
    """

    first: Float[np.ndarray, "p 3"]
    second: Float[np.ndarray, "p 3"]
    rms: float
    first_sd: Float[np.ndarray, " 3"] | None = None
    second_sd: Float[np.ndarray, " 3"] | None = None
    looseness: float | None = None

    @property
    def middle(self) -> Float[np.ndarray, " 3"]:
        """In the first segment's frame [m]."""
        return np.asarray(self.first.mean(axis=0))


def centre_points(first: RigidTransform, second: RigidTransform) -> JointPoints:
    """The centre that two segments share along their poses; ValueError as `functional_centre` has it."""
    found = functional_centre(first, second)
    return JointPoints(found.first[None], found.second[None], found.rms, found.first_sd, found.second_sd)


def axis_points(first: RigidTransform, second: RigidTransform, near: Float[np.ndarray, " 3"]) -> JointPoints:
    """Two points of the axis that two segments share, `HALF` to either side of where it is next to `near`.

    `near` is in the first segment's frame [m]. ValueError as `functional_axis` has it.
    """
    found = functional_axis(first, second)
    along = found.first_direction @ (near - found.first)
    steps = np.array([[along - HALF], [along + HALF]])
    return JointPoints(
        found.first + steps * found.first_direction,
        found.second + steps * found.second_direction,
        found.rms,
        looseness=found.looseness,
    )


def apart_in_halves(first: RigidTransform, second: RigidTransform, near: Float[np.ndarray, " 3"] | None) -> float:
    """Distance between the middles found from either half of the frames [m]; NaN where one of them moves too little.

    One half is the first and the third quarter. It holds what standard errors leave out: skin slides smoothly, and the
    same way for many frames. `near` as in `axis_points`; None of a centre.
    """
    quarter = 4 * np.arange(len(first)) // len(first)
    halves = np.flatnonzero(quarter % 2 == 0), np.flatnonzero(quarter % 2 == 1)
    parts = [(first[half], second[half]) for half in halves]
    try:
        one, other = (centre_points(*part) if near is None else axis_points(*part, near) for part in parts)
    except ValueError:
        return float("nan")
    return float(np.linalg.norm(one.middle - other.middle))

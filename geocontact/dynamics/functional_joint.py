"""Centre or axis of a joint from how two segments move against each other.

SCoRE: Ehrig, Taylor, Duda & Heller (2006), A survey of formal methods for determining the centre of rotation of ball
joints, J Biomech 39, 2798-2809. SARA: the same authors (2007), A survey of formal methods for determining functional
joint axes, J Biomech 40, 2150-2157. Both solve R1 c1 + t1 = R2 c2 + t2 for the point in both segments; with an axis
every point of it does, and the direction is what the matrix [R1, -R2] takes to nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

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

"""From the laboratory's frame to the device's: three reference markers, frame by frame.

Yao et al. (2024), Robotics 13:27, sec. 2.2, eqs 1-4: the origin moves to Lucy_MC, R1 turns Lucy_MC → Lucy_Mleft into x,
R2 turns about x until T10 lies where it lies on a wearer who stands upright.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

HALF_TURN = np.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True)
class DeviceFrame:
    """Pose of the device's frame L in the laboratory G, frame by frame.

    Parameters
    ----------
    origin
        p_GL, marker Lucy_MC [m].
    rotation
        R_LG: turns components in G into components in L. NaN where a reference marker was not seen.
    """

    origin: Float[np.ndarray, "t 3"]
    rotation: Float[np.ndarray, "t 3 3"]

    def points(self, places: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3"]:
        """Points of G in L [m], eq. 4."""
        return self.vectors(places - self.origin)

    def vectors(self, directions: Float[np.ndarray, "t 3"] | Float[np.ndarray, " 3"]) -> Float[np.ndarray, "t 3"]:
        """Directions of G in L."""
        return np.asarray(np.einsum("tij,tj->ti", self.rotation, np.broadcast_to(directions, self.origin.shape)))


def device_frame(
    origin: Float[np.ndarray, "t 3"],
    left: Float[np.ndarray, "t 3"],
    below: Float[np.ndarray, "t 3"],
    pitch: float = 0.0,
) -> DeviceFrame:
    """Frame of the device from Lucy_MC, Lucy_Mleft and T10 [m].

    Parameters
    ----------
    pitch
        Angle in the plane across x from straight below Lucy_MC to T10, positive where T10 lies farther back [rad]; see
        `upright_pitch`. The paper takes what it is while standing upright, without its number.
    """
    first = aligned_with_x(left - origin)
    lateral = np.einsum("tij,tj->ti", first, below - origin)
    theta = pitch - np.arctan2(lateral[:, 1], -lateral[:, 2])
    return DeviceFrame(origin, about_x(theta) @ first)


def upright_pitch(
    origin: Float[np.ndarray, "t 3"],
    left: Float[np.ndarray, "t 3"],
    below: Float[np.ndarray, "t 3"],
    up: Float[np.ndarray, " 3"],
) -> float:
    """Pitch of T10 with which z is upright, in the mean over frames in which the wearer stands upright [rad].

    Parameters
    ----------
    up
        In the laboratory's frame, of any length.
    """
    frame = device_frame(origin, left, below)
    vertical = np.nanmean(frame.vectors(up / np.linalg.norm(up)), axis=0)
    return float(np.arctan2(vertical[1], vertical[2]))


def aligned_with_x(vectors: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """Shortest turns R1 of vectors into x, eq. 2.

    The paper prints the vector u where its skew form belongs: R = cos α I + sin α [u]× + (1 - cos α) u uᵀ. Vectors that
    point against x, where u is lost, are first given half a turn about z; the turn about x that follows undoes it.
    """
    unit = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    against = unit[:, 0] < 0.0
    unit = np.where(against[:, None], unit @ HALF_TURN, unit)
    cosine = unit[:, 0]
    across = np.column_stack((np.zeros(len(unit)), unit[:, 2], -unit[:, 1]))  # v × x = sin α u
    squared = across[:, :, None] * across[:, None, :] / (1.0 + cosine)[:, None, None]  # (1 - cos α) u uᵀ
    turns = cosine[:, None, None] * np.eye(3) + _skew(across) + squared
    return np.asarray(np.where(against[:, None, None], turns @ HALF_TURN, turns))


def about_x(angle: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 3 3"]:
    """Turns R2 about x by an angle [rad], eq. 3."""
    found = np.zeros((len(angle), 3, 3))
    found[:, 0, 0] = 1.0
    found[:, 1, 1] = found[:, 2, 2] = np.cos(angle)
    found[:, 2, 1] = np.sin(angle)
    found[:, 1, 2] = -found[:, 2, 1]
    return found


def _skew(v: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """[v]×, so that [v]× w = v × w."""
    found = np.zeros((len(v), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[:, i, j], found[:, j, i] = -v[:, k], v[:, k]
    return found

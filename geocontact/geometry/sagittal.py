"""Flexion angles of places on a component: where a point lies about an axis, from one direction towards another.

Scalar in, scalar out: columns of arrays and CasADi symbols go through the same lines, so that a tube's distance and the
contact inside of it in a simulation are one formula.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.sweep import Axis

X = TypeVar("X", bound=Any)
"""A number, a column or a symbol."""


def off_axis(offset: tuple[X, X, X], axis: tuple[X, X, X]) -> tuple[X, tuple[X, X, X]]:
    """Distance along a unit vector, and the part of the offset that is across it, in the same axes.

    Parameters
    ----------
    offset
        From any point of the line to the point [m].
    axis
        Unit vector along the line.
    """
    along = offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2]
    return along, (offset[0] - along * axis[0], offset[1] - along * axis[1], offset[2] - along * axis[2])


def silhouette(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], direction: Float[np.ndarray, " 3"]
) -> Int[np.ndarray, "e 2"]:
    """Edges (pairs of vertices) where the surface turns away from `direction`, and open edges.

    Parameters
    ----------
    vertices, faces
        Triangle surface; corners in one sense of rotation. A vertex that stands twice counts twice: merge it before.
    direction
        From the surface towards the eye.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    looks = np.cross(b - a, c - a) @ direction > 0.0
    corners = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges, which = np.unique(np.sort(corners, axis=1), axis=0, return_inverse=True)
    seen = np.bincount(which.ravel(), np.tile(looks, 3), len(edges))
    around = np.bincount(which.ravel(), minlength=len(edges))
    return np.asarray(edges[((seen > 0) & (seen < around)) | (around == 1)])


STEEPEST = 0.95  # cosine to the axis above which a direction says nothing about angles around it
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Sagittal:
    """Plane across `axis`, with the direction of 0 and one on the side of 90 degrees, all in the component's frame.

    Which way a file's axes point is not known beforehand (the femoral components of two public data sets, one of them
    described as having x anterior, both have their condyles at +x), so both directions are the caller's.

    Parameters
    ----------
    axis
        Flexion axis; its sense does not matter.
    zero
        Where the flexion angle is 0 as seen from the axis: distal, usually.
    ninety
        On the side where it is 90 degrees: posterior, usually.
    """

    axis: Axis
    zero: Vector
    ninety: Vector

    def __post_init__(self) -> None:
        along = self.frame[2]
        zero, ninety = (np.asarray(v, float) / np.linalg.norm(v) for v in (self.zero, self.ninety))
        if max(abs(zero @ along), abs(ninety @ along)) > STEEPEST:
            raise ValueError("a direction of 0 or 90 degrees lies along the axis")
        if abs(zero @ ninety) > STEEPEST:
            raise ValueError("the directions of 0 and 90 degrees are the same")

    @cached_property
    def frame(self) -> Float[np.ndarray, "3 3"]:
        """Rows: unit vectors to 0 and to 90 degrees across the axis, and along the axis; right-handed."""
        along = np.asarray(self.axis.direction, float) / np.linalg.norm(self.axis.direction)
        zero = np.asarray(self.zero, float) - (np.asarray(self.zero) @ along) * along
        zero /= max(float(np.linalg.norm(zero)), 1e-300)
        ninety = np.cross(along, zero)
        if ninety @ np.asarray(self.ninety) < 0.0:
            along, ninety = -along, -ninety
        return np.stack([zero, ninety, along])

    def local(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """Coordinates towards 0, towards 90 degrees and along the axis [m]."""
        return np.asarray((points - np.asarray(self.axis.point)) @ self.frame.T)

    def placed(self, local: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """The way back."""
        return np.asarray(local @ self.frame + np.asarray(self.axis.point))

    def angle(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Flexion angle of each point, in (-pi, pi] [rad]."""
        here = self.local(points)
        return np.asarray(np.arctan2(here[:, 1], here[:, 0]))

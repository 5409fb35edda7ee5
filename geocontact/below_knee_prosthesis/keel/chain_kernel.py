"""A chain of hinges: where its joints are, how they have turned what they carry, and vectors that are not allocated."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.compile import kernel

Vector = tuple[float, float, float]
"""Three numbers: arrays would be allocated, which takes longer than what is done with them."""


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def plus(a: Vector, b: Vector, factor: float) -> Vector:
    """a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@kernel
def row(table: Float[np.ndarray, "m 3"], at: int) -> Vector:
    """A row of a table."""
    return table[at, 0], table[at, 1], table[at, 2]


@kernel
def along(n: Vector, v: Vector) -> Vector:
    """What of v lies in the plane of the unit normal n."""
    return plus(v, n, -dot(n, v))


@kernel
def chain(
    y: Float[np.ndarray, " m"], rest: Float[np.ndarray, "m 3"], axes: Float[np.ndarray, "m 3"]
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3 3"]]:
    """Places and axes of the joints, and how each has turned what it carries."""
    count = y.size
    place, axis, turned = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    before, own = np.eye(3), np.empty((3, 3))
    for j in range(count):
        for r in range(3):
            if j == 0:
                place[j, r] = rest[j, r]
            else:
                place[j, r] = place[j - 1, r]
                for q in range(3):
                    place[j, r] += before[r, q] * (rest[j, q] - rest[j - 1, q])
            axis[j, r] = before[r, 0] * axes[j, 0] + before[r, 1] * axes[j, 1] + before[r, 2] * axes[j, 2]
        s, c = np.sin(y[j]), np.cos(y[j])
        a = axes[j]
        for r in range(3):
            for q in range(3):
                own[r, q] = (1.0 - c) * a[r] * a[q] + (c if r == q else 0.0)
        own[0, 1] -= s * a[2]
        own[0, 2] += s * a[1]
        own[1, 0] += s * a[2]
        own[1, 2] -= s * a[0]
        own[2, 0] -= s * a[1]
        own[2, 1] += s * a[0]
        for r in range(3):
            for q in range(3):
                turned[j, r, q] = before[r, 0] * own[0, q] + before[r, 1] * own[1, q] + before[r, 2] * own[2, q]
        before = turned[j].copy()
    return place, axis, turned


@kernel
def carried(
    point: Float[np.ndarray, " 3"],
    last: int,
    rest: Float[np.ndarray, "m 3"],
    place: Float[np.ndarray, "m 3"],
    turned: Float[np.ndarray, "m 3 3"],
) -> Vector:
    """Where a point that joint `last` carries has come to; -1 for a point of K."""
    if last < 0:
        return point[0], point[1], point[2]
    x, y, z = point[0] - rest[last, 0], point[1] - rest[last, 1], point[2] - rest[last, 2]
    R, at = turned[last], place[last]
    return (
        at[0] + R[0, 0] * x + R[0, 1] * y + R[0, 2] * z,
        at[1] + R[1, 0] * x + R[1, 1] * y + R[1, 2] * z,
        at[2] + R[2, 0] * x + R[2, 1] * y + R[2, 2] * z,
    )

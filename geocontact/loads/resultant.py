"""Many forces at points as one force, one moment, one centre, and the velocities of those points."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.frame_blocks import release, room
from geocontact.data.wrench import Wrench


def weighted_centre(
    points: Float[np.ndarray, "*t n 3"], weights: Float[np.ndarray, "*t n"], what: str = "centre"
) -> Float[np.ndarray, "*t 3"]:
    """Sum of w x over sum of w, for one set of points or a stack of sets.

    Weights are areas, normal forces or pressures times areas: not negative, and not all zero. A point of weight zero
    may be NaN. It lies within the convex hull of the points, moves with them and does not depend on their order or on
    the unit of the weights.

    Parameters
    ----------
    what
        What it is the centre of, for the message when there is none.
    """
    if (weights < 0.0).any() or not np.isfinite(weights).all():
        raise ValueError(f"no {what}: weights must be finite and not negative, smallest is {weights.min():g}")
    total = weights.sum(axis=-1)
    if not (total > 0.0).all():
        raise ValueError(f"no {what}: the {weights.shape[-1]} weights sum to 0")
    counted = np.where(weights[..., None] > 0.0, points, 0.0)
    return np.asarray(np.einsum("...n,...nk->...k", weights, counted) / total[..., None])


def resultant(
    force: Float[np.ndarray, "*t n 3"],
    point: Float[np.ndarray, "*t n 3"],
    frame: str,
    origin: Float[np.ndarray, " 3"] | None = None,
) -> Wrench:
    """Sum of the forces [N] that act at `point` [m], about `origin` (that of the frame without).

    A point at which no force acts may be NaN.
    """
    about = np.zeros(3) if origin is None else origin
    acts = (force != 0.0).any(axis=-1, keepdims=True)
    arm = np.where(acts, point - about, 0.0)
    total = force.sum(axis=-2)
    return Wrench(total, np.cross(arm, force).sum(axis=-2), np.broadcast_to(about, total.shape), frame)


CUBIC = 3
WINDOW = 1 << 13
"""Frames whose spline is fitted at a time."""
BESIDE = 64
"""Frames on either side of them that go into it. The slopes of a spline solve equations whose diagonal is twice the sum
of the rest (de Boor 2001, A practical guide to splines, ch. 4), so that a frame's weight at least halves from one frame
to the next: what lies farther away changes no digit (2^-64)."""


def pose_rate(time: Float[np.ndarray, " t"], poses: RigidTransform) -> Float[np.ndarray, "t 4 4"]:
    """Time derivative of the pose matrices: the velocity of a point p of the body is (dX/dt p) [m/s].

    The derivative of the cubic spline (not-a-knot) through the matrices' entries, which gives each point of the body
    the velocity of the spline through its own recorded positions: the same in every frame, the error of third order in
    the time step. Linear with two or three frames, zero with one. Nothing is smoothed: filter noisy motion beforehand.
    """
    from scipy.interpolate import make_interp_spline

    if len(time) == 1:
        return np.zeros((1, 4, 4))
    found, order = room((len(time), 4, 4)), CUBIC if len(time) > CUBIC else 1
    for start in range(0, len(time), WINDOW):
        stop = min(start + WINDOW, len(time))
        some = slice(max(0, start - BESIDE), stop + BESIDE)
        spline = make_interp_spline(time[some], poses[some].as_matrix(), k=order)
        found[start:stop] = spline.derivative()(time[start:stop])
        release()
    return found

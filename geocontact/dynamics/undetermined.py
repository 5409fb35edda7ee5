"""Coordinates that markers do not determine: in one frame, and in no pose at all."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import qr

Square = Float[np.ndarray, "n n"]

NOTHING = 1e-9  # curvature along a direction that markers do not tell, where that of each coordinate is 1
PART = 1e-3  # of a unit direction that belongs to a coordinate
HARDLY = 5e-3  # m that all markers together move by in a turn of 1 rad: a millimetre of noise is more than 11 degrees


def undetermined(normal: Square, free: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """Coordinates with a part in a direction along which nothing counts.

    Parameters
    ----------
    normal
        Curvature of the sum of squares after Gauss and Newton.
    free
        Coordinates that the search moves.
    """
    found = np.zeros(len(free), dtype=bool)
    inner = normal[np.ix_(free, free)]
    unit = np.sqrt(np.where(np.diag(inner) > 0.0, np.diag(inner), 1.0))
    size, directions = np.linalg.eigh(inner / np.outer(unit, unit))
    idle = directions[:, size <= NOTHING]
    found[np.flatnonzero(free)] = np.abs(idle).max(axis=1, initial=0.0) > PART
    return found


def to_hold(slopes: Float[np.ndarray, "k n"], free: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """As few coordinates as there are directions along which markers hardly move; without them the others are told.

    Of each direction that which turns or shifts most along it (Golub & Van Loan, Matrix Computations, sec. 5.5: columns
    exchanged by their length): of an arm with markers at shoulder, elbow and wrist the pronation, not the elbow, which
    makes up for it by a little.

    Parameters
    ----------
    slopes
        Derivatives of what counts [m] by the coordinates [rad, m].
    """
    found = np.zeros(len(free), dtype=bool)
    inner = slopes[:, free]
    _, size, directions = np.linalg.svd(inner, full_matrices=True)
    idle = directions[np.append(size, np.zeros(inner.shape[1] - len(size))) < HARDLY]
    if len(idle):
        order = qr(idle, mode="r", pivoting=True)[1]
        found[np.flatnonzero(free)[order[: len(idle)]]] = True
    return found

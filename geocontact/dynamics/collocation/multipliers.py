"""Multipliers of a solution carried to a finer mesh, so that a search there starts near its end.

With λ of the states' slopes at the points, weights w of these and κ of the continuity at an interval's end, λ/w is the
costate's polynomial and does not change with the interval's length; multipliers of the path stand for an integral and
are proportional to it. κ follows from what lies behind it: the Lagrangian does not change with the state there,

    κ_k = Σ_j λ_j D_j0 + κ_k+1 c_0   of the interval after,

with D the derivative and c the end of the state's polynomial (Garg et al. (2011), Computational Optimization and
Applications 49, on costates of collocation).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

if TYPE_CHECKING:
    from geocontact.dynamics.collocation.transcription import Mesh, Transcription

Vector = Float[np.ndarray, " _"]
Rows = Float[np.ndarray, "m r"]
WHOLE = 0.999
"""Part of an interval from which on it is the same one, but for rounding."""


def carried(on: Transcription, meshes: tuple[Mesh, ...], multipliers: tuple[Vector, Vector]) -> tuple[Vector, Vector]:
    """Multipliers of the bounds and of the constraints of `on`, from those of coarser meshes.

    Bounds of an interval that was cut count as not reached, but for its start.

    Parameters
    ----------
    meshes
        Of the same problem and points; every node of theirs is one of `on`'s meshes.
    """
    s = on.problem.system
    of_bounds, of_rows = multipliers
    width, height = on.stride, on.scheme.degree * (on.nx + s.path.numel()) + on.nx
    bounds, rows = [of_bounds[: on.np]], list[Vector]()
    first, row = on.np, 0
    for coarse, fine in zip(meshes, on.meshes, strict=True):
        count = len(coarse) - 1
        own = np.searchsorted(coarse, 0.5 * (fine[1:] + fine[:-1])) - 1
        begin = (fine[:-1] - coarse[own]) / np.diff(coarse)[own]
        part = np.diff(fine) / np.diff(coarse)[own]
        duration, last = first, first + 1 + width * count
        states = of_bounds[duration + 1 : last].reshape(count, width)[own]
        states[part < WHOLE, on.nx :] = 0.0
        states[begin > 1.0 - WHOLE, : on.nx] = 0.0
        bounds += [of_bounds[duration : duration + 1], states.ravel(), of_bounds[last : last + on.nx]]
        each = of_rows[row : row + height * count].reshape(count, height)
        rows.append(_rows(on, each[own], begin, part).ravel())
        first, row = last + on.nx, row + height * count
    return np.concatenate(bounds), np.concatenate([*rows, of_rows[row:]])


def _rows(on: Transcription, coarse: Rows, begin: Vector, part: Vector) -> Rows:
    """Multipliers of all rows of every interval of a finer mesh, from those of the interval that it lies in."""
    scheme, nx, count = on.scheme, on.nx, len(coarse)
    points, ends = coarse[:, :-nx].reshape(count, scheme.degree, -1), coarse[:, -nx:].copy()
    where = (begin[:, None] + part[:, None] * scheme.points).ravel()
    weights = scheme.of_controls(where).reshape(count, scheme.degree, scheme.degree)
    found = np.einsum("mij,mjr->mir", weights, points / scheme.weights[:, None]) * scheme.weights[:, None]
    found[:, :, nx:] *= part[:, None, None]
    end = scheme.of_states(np.ones(1))[0]
    for k in range(count - 2, -1, -1):
        if begin[k] + part[k] < WHOLE:
            ends[k] = scheme.derivative[:, 0] @ found[k + 1, :, :nx] + end[0] * ends[k + 1]
    return np.hstack([found.reshape(count, -1), ends])


def nested(coarse: tuple[Mesh, ...], fine: tuple[Mesh, ...]) -> bool:
    """Whether every node of the coarse meshes is one of the fine ones."""
    return all(np.isin(each, other).all() for each, other in zip(coarse, fine, strict=True))

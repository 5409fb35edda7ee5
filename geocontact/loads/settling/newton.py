"""Equilibrium by Newton's method on the energy, with a line search.

Nocedal & Wright, Numerical Optimization (2006), sec. 3.4: directions of negative curvature are turned over, so that
every step goes downhill, and a step is halved until the energy falls by a share of what its slope promises (Armijo).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.loads.settling.potential import AxialLoad, Bed, Total, total_at

ARM = 0.02
"""m; lever at which a turn counts like a displacement, and a moment like a force."""

LONGEST = 1e-3
"""m; no step moves further."""

EXACT = 1e-6
"""Of the load: what the forces may leave over."""

FACETED = 1e-3
"""Of the load: what they may leave over where no step lowers the energy any more. Slopes of the smooth surface over the
facets do not quite meet where the closest face changes."""

STEPS = 60
HALVINGS = 25
PROMISED = 1e-4
LEAST = 1e-9
"""Of the largest curvature: smaller ones are taken for this."""


@dataclass(frozen=True, eq=False)
class Rest:
    """Where the search ended.

    Parameters
    ----------
    total
        Energy and derivatives there.
    residual
        Largest force left over along a free coordinate, moments over 20 mm [N].
    steps
        Newton steps.
    converged
        Whether that is equilibrium.
    """

    total: Total
    residual: float
    steps: int
    converged: bool


def scales() -> Float[np.ndarray, " 6"]:
    """Coordinates per metre of the scaled ones."""
    return np.array([1.0, 1.0, 1.0, 1.0 / ARM, 1.0 / ARM, 1.0 / ARM])


def equilibrium(bed: Bed, pull: AxialLoad, start: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]) -> Rest:
    """Coordinates at which nothing moves on along the free ones, from `start`; the others stay."""
    now = total_at(bed, pull, start)
    for step in range(STEPS):
        left = _left(now, free)
        if left <= EXACT * pull.load:
            return Rest(now, left, step, True)
        following = _lower(bed, pull, now, free)
        if following is None:
            return Rest(now, left, step, left <= FACETED * pull.load)
        now = following
    left = _left(now, free)
    return Rest(now, left, STEPS, left <= FACETED * pull.load)


def _left(now: Total, free: Bool[np.ndarray, " 6"]) -> float:
    return float(np.abs((now.slope * scales())[free]).max())


def _lower(bed: Bed, pull: AxialLoad, now: Total, free: Bool[np.ndarray, " 6"]) -> Total | None:
    """The next point of the search; None where no step lowers the energy."""
    direction, promised = downhill(now, free)
    share = min(1.0, LONGEST / max(float(np.abs(direction / scales()).max()), 1e-300))
    for _ in range(HALVINGS):
        tried = total_at(bed, pull, now.values + share * direction)
        if tried.potential <= now.potential + PROMISED * share * promised:
            return tried
        share *= 0.5
    return None


def downhill(now: Total, free: Bool[np.ndarray, " 6"]) -> tuple[Float[np.ndarray, " 6"], float]:
    """Newton step [m, rad] and the change of energy per share of it [J]."""
    scale = scales()[free]
    slope = now.slope[free] * scale
    curvature, directions = np.linalg.eigh(now.stiffness[np.ix_(free, free)] * np.outer(scale, scale))
    size = np.maximum(np.abs(curvature), LEAST * max(float(np.abs(curvature).max()), 1.0))
    step = -directions @ ((directions.T @ slope) / size)
    full = np.zeros(6)
    full[free] = step * scale
    return full, float(slope @ step)

"""A second spring that is met at a limit."""

from __future__ import annotations

from geocontact.geometry.kernels.compile import kernel


@kernel
def stop_force(u: float, stiffness: float, limit: float, side: float) -> float:
    """Force of a stop on the upper (`side` +1) or lower (-1) side, side k max(side (u - limit), 0) [N]."""
    return side * stiffness * max(side * (u - limit), 0.0)

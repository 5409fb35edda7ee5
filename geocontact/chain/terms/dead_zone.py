"""Play: nothing happens while the deflection stays inside it."""

from __future__ import annotations

from geocontact.geometry.kernels.compile import kernel


@kernel
def beyond_play(u: float, width: float, share: float) -> float:
    """Deflection beyond a play of `width` around rest, u - min(max(u, -(1 - share) width), share width) [m].

    `share` of the play lies on the positive side; 0.5 is a body at rest in the middle of its slack.
    """
    return u - min(max(u, -(1.0 - share) * width), share * width)

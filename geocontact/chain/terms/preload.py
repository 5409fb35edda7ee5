"""Tension of a strap at rest."""

from __future__ import annotations

from geocontact.geometry.kernels.compile import kernel


@kernel
def strap_tension(u: float, tension: float, slackening: float) -> float:
    """Force of a strap that is tight at rest, tension min(max(1 + slackening u, 0), 1) [N].

    A strap that is let out by 1/slackening hangs slack; with `slackening` = 0 [1/m] its tension is constant.
    """
    return tension * min(max(1.0 + slackening * u, 0.0), 1.0)

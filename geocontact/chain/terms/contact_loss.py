"""A contact that pushes and never pulls, and may stand open by a gap."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def closed_by(x: float, rounding: float) -> tuple[float, float]:
    """What is pressed when the bodies overlap by `x`, and how much of a rate of `x` presses it.

    max(x, 0) for `rounding` 0; else (x + sqrt(x² + rounding²))/2, a pad whose edge meets the body before the rest.
    """
    if rounding <= 0.0:
        return max(x, 0.0), 1.0 if x > 0.0 else 0.0
    root = math.hypot(x, rounding)
    return 0.5 * (x + root), 0.5 * (1.0 + x / root)


@kernel
def pushing(force: float, side: float) -> float:
    """The force as far as it pushes: max(side force, 0) side [N]; `side` +1 or -1 is the sign of a push."""
    return side * max(side * force, 0.0)

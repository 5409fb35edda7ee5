"""A contact that pushes and never pulls, and may stand open by a gap."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def transmitted(force: float, opening: float, rounding: float, side: float) -> float:
    """What is left of a `force` once the contact has closed [N]; `side` +1 or -1 is the sign of a push.

    max(x, 0), x = side force - opening, for `rounding` 0; else (x + sqrt(x² + rounding²))/2: a pad whose edge meets the
    body before the rest. The opening is the load that closing the gap would take without one: stiffness times gap.
    """
    x = side * force - opening
    if rounding <= 0.0:
        return side * max(x, 0.0)
    return side * 0.5 * (x + math.hypot(x, rounding))

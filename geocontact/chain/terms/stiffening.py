"""A spring that becomes stiffer the further it is deflected."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def stiffening_factor(u: float, gain: float, exponent: float, reference: float) -> float:
    """Secant stiffness over that at rest, 1 + gain (|u| / reference)^exponent [-]."""
    return 1.0 + gain * math.pow(abs(u) / reference, exponent)

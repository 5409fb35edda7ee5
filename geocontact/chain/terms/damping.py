"""Force against the rate of deflection."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def power_damping(rate: float, b: float, exponent: float, reference: float) -> float:
    """b v |v / reference|^(exponent - 1) [N]: linear for exponent 1, and b v at the reference rate for any."""
    if rate == 0.0:
        return 0.0
    return b * rate * math.pow(abs(rate / reference), exponent - 1.0)

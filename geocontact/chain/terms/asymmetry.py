"""A spring that is stiffer while it is loaded than while it is let go."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def direction_factor(rate: float, excess: float, turning: float) -> float:
    """1 + excess tanh(rate / turning) [-]: 1 + excess while loading, 1 - excess while unloading.

    `rate` is positive while the deflection grows in magnitude; `turning` [m/s] is the rate at which the change from one
    to the other is three quarters done.
    """
    return 1.0 + excess * math.tanh(rate / turning)

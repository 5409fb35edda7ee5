"""A second spring that is met at a limit, all at once or through a buffer."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def stop_force(u: float, stiffness: float, limit: float, side: float, power: float, reference: float) -> float:
    """Force of a stop on the upper (`side` +1) or lower (-1) side, side k D (max(side (u - limit), 0)/D)^p [N].

    D is the `reference` [m]; p = 1 is a second spring, p = 3/2 a rounded buffer, pressed as in Hertz's contact.
    """
    beyond = max(side * (u - limit), 0.0)
    if power != 1.0:
        beyond = reference * math.pow(beyond / reference, power)
    return side * stiffness * beyond

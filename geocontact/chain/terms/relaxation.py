"""A Maxwell branch beside the spring."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def branch_force(branch: float, elastic_step: float, h: float, ratio: float, tau: float) -> float:
    """Force of the branch after a step of `h` seconds over which the spring's force rose by `elastic_step` [N].

    q' = ratio F_el' - q / tau, exact for a spring force that is linear in time over the step.
    """
    if h <= 0.0:
        return branch
    return branch * math.exp(-h / tau) - ratio * elastic_step * (tau / h) * math.expm1(-h / tau)

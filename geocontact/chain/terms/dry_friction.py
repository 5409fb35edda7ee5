"""Dry friction with a pre-sliding range: of displacement, or of rate."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def friction_state(state: float, step: float, reach: float) -> float:
    """Friction over its limit, in -1..1, after a displacement `step` [m].

    Dahl's model dz/du = (sign(u') - z) / reach, which is solved exactly while the direction does not change; so the
    answer does not depend on how finely a stroke is sampled. `reach` [m] is the pre-sliding range.
    """
    if step == 0.0:
        return state
    towards = math.copysign(1.0, step)
    return towards + (state - towards) * math.exp(-abs(step) / reach)


@kernel
def friction_at_rate(rate: float, turning: float) -> float:
    """Friction over its limit, tanh(rate / turning), in -1..1: a contact that creeps below the rate `turning` [m/s]."""
    return math.tanh(rate / turning)

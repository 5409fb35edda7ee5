"""Limits of the colours of distances: the same in every frame, on the page and in the figure."""

from __future__ import annotations

import numpy as np

from geocontact.data.evolution import AreaEvolution

TICK = 0.5e-3  # m; the colours end at a round number


def colour_span(e: AreaEvolution) -> tuple[float, float]:
    """Lower and upper end [m]: below the deepest overlap where it is known, up to the largest threshold evaluated."""
    farthest = max((*e.thresholds, *e.sensitivity_thresholds, TICK))
    if e.signed == "none":
        return (0.0 if min(e.thresholds) > 0.0 else -TICK), farthest
    deepest = min(-0.25 * max(e.thresholds), float(e.min_distance.min()), -TICK)
    return float(-np.ceil(-deepest / TICK) * TICK), farthest

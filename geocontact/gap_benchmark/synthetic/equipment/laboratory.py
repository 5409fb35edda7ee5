"""Who records a scene."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.gap_benchmark.synthetic.equipment.clock import USUAL, Clock
from geocontact.gap_benchmark.synthetic.equipment.placement import IN_PLACE, Placement
from geocontact.gap_benchmark.synthetic.equipment.recorder import EXACT, Recorder


@dataclass(frozen=True)
class Laboratory:
    """Drawn for one case: what records it, when, and how far placement is off in each trial."""

    recorder: Recorder = EXACT
    clock: Clock = USUAL
    placement: Placement = IN_PLACE


HOME = Laboratory()
"""Adds nothing to a scene: noise as large everywhere, numbers in full, even samples, everything in its place."""

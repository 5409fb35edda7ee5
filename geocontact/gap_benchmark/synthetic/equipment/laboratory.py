"""Who records a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from geocontact.gap_benchmark.synthetic.equipment.clock import USUAL, Clock
from geocontact.gap_benchmark.synthetic.equipment.placement import IN_PLACE, Placement
from geocontact.gap_benchmark.synthetic.equipment.recorder import EXACT, Recorder
from geocontact.gap_benchmark.synthetic.equipment.sampler import AT_ONCE, Sampler
from geocontact.gap_benchmark.synthetic.equipment.warm_up import WARM, WarmUp

Forms = Literal["first", "second"]
"""Family of equations that effects are planted by."""


@dataclass(frozen=True)
class Laboratory:
    """Drawn for one case: what records it, when, how far things are off, and how many trials there are.

    Parameters
    ----------
    recorder, clock, sampler
        Of all trials.
    placement
        How far things are off in each trial, drawn anew in every one (standard deviations).
    standing
        How far constants are off from what is told, the same in all trials.
    warm_up
        What channels are off by until the sensors are warm.
    trials
        How many for calibration and for evaluation; drawn where None.
    forms
        Of what is planted.
    """

    recorder: Recorder = EXACT
    clock: Clock = USUAL
    sampler: Sampler = AT_ONCE
    placement: Placement = IN_PLACE
    standing: Placement = IN_PLACE
    warm_up: WarmUp = WARM
    trials: tuple[int, int] | None = None
    forms: Forms = "first"


HOME = Laboratory()
"""Adds nothing to a scene: noise as large everywhere, numbers in full, even samples, everything in its place."""

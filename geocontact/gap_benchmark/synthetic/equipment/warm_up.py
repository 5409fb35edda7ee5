"""Sensors that warm up: gains and zeros that are off in the first trials and settle from trial to trial."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.gap_benchmark.synthetic.equipment.placement import IN_PLACE, Placement


@dataclass(frozen=True)
class WarmUp:
    """Off by `cold` exp(-turn/`trials`) in the trial of number `turn`."""

    cold: Placement = IN_PLACE
    trials: float = 1.0

    def at(self, turn: int) -> Placement:
        """What is left in a trial."""
        return self.cold.times(np.full(len(self.cold), np.exp(-turn / self.trials)))


WARM = WarmUp()
"""Nothing is off."""

"""One recorded trial: what was measured over time, and what is known of its circumstances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.data.motion import Signals


@dataclass(frozen=True)
class Trial:
    """Inputs and outputs of a trial in SI units; NaN where a channel was not measured.

    Parameters
    ----------
    name
        What the trial is called.
    signals
        Its columns over time.
    covariates
        Numbers that hold for the whole trial ("level", "cuff_pressure"), SI units.
    labels
        Words that do ("condition": "locked").
    """

    name: str
    signals: Signals
    covariates: Mapping[str, float] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.signals.time)

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of each row [s], strictly increasing."""
        return self.signals.time

    def column(self, name: str) -> Float[np.ndarray, " t"]:
        """Values of one channel; KeyError when there is none of that name."""
        return self.signals.column(name)

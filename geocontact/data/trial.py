"""One recorded trial, and many cycles together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.data.motion import Signals


def mean_and_sd(trials: Float[np.ndarray, "trials t"]) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Mean and sample standard deviation (n - 1) at each instant over the trials that have a value there.

    NaN where no trial has one, and as SD where only one has. Where trials drop out, the mean may jump.
    """
    there = np.isfinite(trials)
    count = there.sum(axis=0)
    mean = np.where(there, trials, 0.0).sum(axis=0) / np.where(count > 0, count, np.nan)
    squares = np.where(there, trials - mean, 0.0) ** 2
    return mean, np.sqrt(squares.sum(axis=0) / np.where(count > 1, count - 1.0, np.nan))


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
    pieces
        First and last time [s] of each piece with every sample, where a long trial is thinned: in between stand means,
        and a straight line is no movement there. Empty for a trial as it was recorded, whatever its steps.
    """

    name: str
    signals: Signals
    covariates: Mapping[str, float] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    pieces: tuple[tuple[float, float], ...] = ()

    def __len__(self) -> int:
        return len(self.signals.time)

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of each row [s], strictly increasing."""
        return self.signals.time

    def column(self, name: str) -> Float[np.ndarray, " t"]:
        """Values of one channel; KeyError when there is none of that name."""
        return self.signals.column(name)

    @property
    def runs(self) -> list[slice]:
        """Rows of each piece, in order; all rows of a trial that is whole."""
        if not self.pieces:
            return [slice(0, len(self))]
        first, last = np.array(self.pieces).T
        begin, end = np.searchsorted(self.time, first), np.searchsorted(self.time, last, side="right")
        return [slice(int(a), int(b)) for a, b in zip(begin, end, strict=True)]

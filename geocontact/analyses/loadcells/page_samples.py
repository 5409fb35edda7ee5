"""Which samples of a recording the page shows: thinned out, and with an empty one in each gap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.page_frames import thinned
from geocontact.identify.signals.gaps import broken, gaps
from geocontact.view.extremes import FRAMES


@dataclass(frozen=True, eq=False)
class Samples:
    """Times that the page shows [s], their numbers by the recorder's clock, and how many these are in all.

    Samples that were lost are counted, so that numbers go with the clock.
    """

    given: Float[np.ndarray, " t"]
    kept: Int[np.ndarray, " k"]
    time: Float[np.ndarray, " s"]
    numbers: Int[np.ndarray, " s"]
    total: int

    def of(self, values: Float[np.ndarray, " t"]) -> Float[np.ndarray, " s"]:
        """What the page shows of values at the recording's own times; NaN in gaps."""
        found = np.full(len(self.time), np.nan)
        found[np.searchsorted(self.time, self.given[self.kept])] = values[self.kept]
        return found


def samples(
    time: Float[np.ndarray, " t"], curves: Sequence[Float[np.ndarray, " t"]] = (), most: int = FRAMES
) -> Samples:
    """Samples with the extremes of the curves, `most` about, those beside gaps, and the middle of each gap."""
    missing = gaps(time)
    after = np.array([np.searchsorted(time, each.end) for each in missing], int)
    kept = np.unique(np.concatenate([thinned(len(time), curves, most=most), after, after - 1])).astype(int)
    step = float(np.median(np.diff(time))) if len(time) > 1 else 1.0
    lost = np.maximum(np.rint(np.diff(time) / step).astype(int) - 1, 0)
    lost[np.setdiff1d(np.arange(len(lost)), after - 1)] = 0
    by_clock = np.arange(1, len(time) + 1) + np.concatenate([[0], np.cumsum(lost)])
    shown, _ = broken(time, time)
    shown = np.unique(np.concatenate([time[kept], np.setdiff1d(shown, time)]))
    numbers = np.rint(np.interp(shown, time, by_clock)).astype(int)
    return Samples(time, kept, shown, numbers, int(by_clock[-1]))

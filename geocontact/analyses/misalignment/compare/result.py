"""What a comparison finds: errors by trial and channel, a figure for each channel, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.misalignment.compare.figure import comparison_figure
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.page import comparison_page
from geocontact.analyses.misalignment.compare.pair import QUANTITIES, Pair
from geocontact.analyses.result import REPORT, Result
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CompareResult(Result):
    """A model beside recordings.

    Parameters
    ----------
    pairs
        Each channel of each trial.
    """

    options: CompareOptions
    pairs: tuple[Pair, ...]

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that were compared."""
        return tuple(channel for channel in QUANTITIES if any(p.channel == channel for p in self.pairs))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`: one row per trial and channel; lengths in mm."""
        return {"comparison": pd.DataFrame([_row(pair) for pair in self.pairs])}

    def figure(self, channel: str = "force") -> Figure:
        """One channel over the angle, all trials; KeyError names those that there are."""
        if channel not in self.channels:
            raise KeyError(f"no channel {channel!r}; there are {', '.join(self.channels)}")
        mine = [p for p in self.pairs if p.channel == channel]
        beta, measured, model = zip(*(p.binned(self.options.bin).T for p in mine), strict=True)
        return comparison_figure([p.trial for p in mine], beta, measured, model, QUANTITIES[channel])

    def figures(self) -> dict[str, Figure]:
        """`comparison_force` and so on, a channel each."""
        return {f"comparison_{each}": self.figure(each) for each in self.channels}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The first trial over time, figures and errors."""
        shown = frame_table("Errors by trial and channel", self.table())
        drawn = {each: drawings[f"comparison_{each}"] for each in self.channels}
        return {REPORT: comparison_page(self.pairs, drawn, [shown], self.record)}


def _row(p: Pair) -> dict[str, object]:
    a, q = p.agreement, QUANTITIES[p.channel]
    return {
        "trial": p.trial,
        "channel": p.channel,
        "unit": q.unit,
        "mae": a.mae * q.per_si,
        "rmse": a.rmsd * q.per_si,
        "bias": a.bias * q.per_si,
        "r2 [-]": a.r2,
        "lag [s]": a.lag,
        "samples": a.samples,
    }

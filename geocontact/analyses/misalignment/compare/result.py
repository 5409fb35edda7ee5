"""A model of the elbow beside recordings: `geocontact elbow compare`, `gc.misalignment.compare`.

>>> import geocontact as gc
>>> trials = gc.misalignment.simulate(rate=20.0, seconds=20.0, trials=2, seed=3).write("trials")
>>> first, second = sorted(trials.glob("locked_*.csv"))
>>> known = {"l": gc.mm(169), "z": gc.mm(127)}
>>> fit = gc.misalignment.identify([first], known=known, bootstrap=0).write("fit") / "elbow.json"
>>> print(gc.misalignment.compare([second], fit=fit))
locked_2, force: MAE 0.644, RMSE 0.809 N, R² 0.947
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.frame.collector import judge, note, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.pairs import (
    QUANTITIES,
    Both,
    Pair,
    compared_pairs,
    comparison_table,
    read,
)
from geocontact.analyses.misalignment.compare.show import channel_curves, comparison_page
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_many_r2
from geocontact.identify.signals.agreement import clock_off, clock_words, gain_off, likely_cause
from geocontact.view.curves.declared import CurveSheet
from geocontact.view.curves.drawn import drawn
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

    @property
    def rmse(self) -> dict[tuple[str, str], float]:
        """Root mean square error of the model by trial and channel: force [N], displacement [m]."""
        return {(pair.trial, pair.channel): pair.agreement.rmsd for pair in self.pairs}

    @property
    def r2(self) -> dict[tuple[str, str], float]:
        """Coefficient of determination by trial and channel [-]."""
        return {(pair.trial, pair.channel): pair.agreement.r2 for pair in self.pairs}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`: one row per trial and channel; lengths in mm."""
        return {"comparison": comparison_table(self.pairs)}

    def figure(self, channel: str = "force") -> Figure:
        """One channel over the angle, all trials; KeyError names those that there are."""
        if channel not in self.channels:
            raise KeyError(f"no channel {channel!r}; there are {', '.join(self.channels)}")
        return drawn(self._sheet(channel))

    def curves(self) -> dict[str, CurveSheet]:
        """`comparison_force` and so on, a channel each."""
        return {f"comparison_{each}": self._sheet(each) for each in self.channels}

    def _sheet(self, channel: str) -> CurveSheet:
        return CurveSheet([channel_curves([p for p in self.pairs if p.channel == channel], self.options.bin)])

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The first trial over time, figures and errors."""
        shown = frame_table("Errors by trial and channel", self.table())
        channels = [panel for sheet in self.curves().values() for panel in sheet.panels]
        return {REPORT: comparison_page(self.pairs, channels, [shown])}


def run(both: Both, o: CompareOptions) -> CompareResult:
    """Errors of every channel that a recording and its model have."""
    pairs = compared_pairs(both, o)
    note("comparison", [{"trial": p.trial, "channel": p.channel, **asdict(p.agreement)} for p in pairs])
    judge(goodness_of(pairs))
    for p in pairs:
        a, q = p.agreement, QUANTITIES[p.channel]
        errors = f"MAE {q.per_si * a.mae:.3g}, RMSE {q.per_si * a.rmsd:.3g} {q.unit}"
        say(f"{p.trial}, {p.channel}: {errors}, R² {a.r2:.3f}")
    return CompareResult(options=o, pairs=pairs)


ALIKE = 1.25
"""Ratio of the gains of trials below which they may be one."""


def goodness_of(pairs: Sequence[Pair]) -> GoodnessOfFit:
    """Every channel of every trial against what was measured."""
    doubts: list[Doubt] = []
    for channel in QUANTITIES:
        mine = [p for p in pairs if p.channel == channel]
        causes = [likely_cause(p.model, p.measured) for p in mine if p.agreement.r2 < 0.0]
        asked = next(filter(None, causes), "")
        found = list(of_many_r2(channel, {p.trial: p.agreement.r2 for p in mine}))
        doubts += [replace(each, what=f"{each.what}{asked}") for each in found]
        gains = [gain_off(p.model, p.measured) for p in mine]
        if mine and not found and 1.0 not in gains and max(gains) < ALIKE * min(gains):
            least, most = min(gains), max(gains)
            size = f"{least:.2f}" if most - least < 0.005 else f"{least:.2f} to {most:.2f}"
            what = f"{channel}: recorded values are {size} times the model's in every trial, and little else differs"
            doubts.append(Doubt(f"{what}: is its stiffness that of this cuff, or the sensor's gain another?", False))
        for p in mine:
            if lag := clock_off(p.model, p.measured, float(p.time[1] - p.time[0])):
                doubts.append(Doubt(f"{p.trial}, {channel}: {clock_words(lag)}", False, abs(lag)))
    return GoodnessOfFit(tuple(doubts), tuple(f"{p.trial}, {p.channel}" for p in pairs))


compare = Job("elbow compare", CompareOptions, read, run)

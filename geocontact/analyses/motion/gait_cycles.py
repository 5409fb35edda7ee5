"""Coordinates or moments from one heel strike of a side to its next: every cycle at 0 … 100 %."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.motion.heel_strikes import Strikes
from geocontact.analyses.motion.sides import LEFT, RIGHT, stem_and_side
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.cycles import STEPS, cut
from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.style import DOUBLE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACROSS, TALL = 3, 0.048  # panels in a row, and their height [m]


@dataclass(frozen=True)
class GaitCycles:
    """Cycles of many curves.

    Parameters
    ----------
    starts
        Heel strikes [s] that lie in the recording, by side; each but the last begins a cycle.
    curves
        By coordinate, a row for each cycle of its own side; of the right, where it has none, else of the left.
    units
        Of the curves, by coordinate.
    """

    starts: Strikes
    curves: Mapping[str, Float[np.ndarray, "_ 101"]]
    units: Mapping[str, str]

    def __bool__(self) -> bool:
        return bool(self.curves)

    @property
    def counts(self) -> dict[str, int]:
        """Cycles by side."""
        return {side: len(starts) - 1 for side, starts in self.starts.items()}

    def table(self) -> pd.DataFrame:
        """Mean and SD of every coordinate at each per cent, lengths in mm; the SD is empty where there is one cycle."""
        columns: dict[str, object] = {"cycle [%]": STEPS}
        for name, trials in self.curves.items():
            unit, factor = ("mm", 1e3) if self.units[name] == "m" else (self.units[name], 1.0)
            mean, sd = (factor * each for each in mean_and_sd(trials))
            columns |= {f"{name}_mean [{unit}]": mean, f"{name}_sd [{unit}]": sd}
        return pd.DataFrame(columns)


def gait_cycles(
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    units: Sequence[str],
    values: Float[np.ndarray, "t n"],
    strikes: Strikes,
) -> GaitCycles:
    """Cut curves at the strikes within the recording; without two strikes of a side there are none."""
    inside = {side: at[(at >= time[0]) & (at <= time[-1])] for side, at in strikes.items()}
    starts = {side: at for side, at in sorted(inside.items(), reverse=True) if len(at) > 1}  # right first
    curves: dict[str, Float[np.ndarray, "_ 101"]] = {}
    for name, column in zip(names, values.T, strict=True):
        own = stem_and_side(name)[1] or next(iter(starts), "")
        trials = cut(time, column, starts[own]) if own in starts else np.zeros((0, len(STEPS)))
        known = trials[np.isfinite(trials)]
        if known.size and np.ptp(known) > 0.0:  # a locked coordinate has no cycle
            curves[name] = trials
    return GaitCycles(starts, curves, {name: unit for name, unit in zip(names, units, strict=True) if name in curves})


@in_style
def cycles_figure(cycles: GaitCycles) -> Figure:
    """Mean ± SD over the gait cycle, both sides of a coordinate in one panel."""
    grouped: dict[str, dict[str, Float[np.ndarray, "_ 101"]]] = {}
    units: dict[str, str] = {}
    for name, trials in cycles.curves.items():
        stem, side = stem_and_side(name)
        title = stem if side else name
        grouped.setdefault(title, {})[side or next(iter(cycles.starts))] = trials
        units[title] = cycles.units[name]
    rows = -(-len(grouped) // ACROSS)
    figure, axes = panels(rows, min(ACROSS, len(grouped)), DOUBLE, TALL * rows)
    for axis, (title, sides) in zip(axes, grouped.items(), strict=False):
        ordered = {side: sides[side] for side in (RIGHT, LEFT) if side in sides}
        mean_over_cycle(STEPS, ordered, Quantity(title, units[title]), axis)
    for spare in axes[len(grouped) :]:
        spare.set_axis_off()
        for letter in spare.texts:
            letter.set_visible(False)
    return figure

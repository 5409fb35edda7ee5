"""Cycles of any channel by gait style: cut from recordings, averaged, and compared with the first style."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.data.errors import InputError
from geocontact.data.gait_events import OFF, STANCE, STRIKE, GaitCycle, GaitEvent, Part, cycles_between, of_recording
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.agreement import rms_difference
from geocontact.identify.signals.cycles import STEPS, normalised, style_shift
from geocontact.io.text.units import split_header

Trials = dict[str, dict[str, Float[np.ndarray, "_ 101"]]]
"""Curves by channel and style, a row for each cycle."""

SLACK = 1e-6
"""s; by which an event may lie outside of its recording."""
UNEVEN = 1.7
"""Times the shortest cycle of a style that its longest may last; an event that is missing makes it 2."""


@dataclass(frozen=True)
class Cutting:
    """Events of a walk, and which part of the cycles between them is used.

    Parameters
    ----------
    file
        Of the events, for messages.
    side
        Side whose cycles count; None where the events have one side only.
    part
        First part of each cycle, or up to its toe off.
    """

    file: Path
    events: tuple[GaitEvent, ...]
    side: str | None
    part: Part

    def cycles_of(self, recording: str) -> list[GaitCycle]:
        """Cycles of one recording; InputError where it has none, or where its side is not known."""
        own = of_recording(self.events, recording)
        sides = sorted({each.side for each in own})
        if self.side is None and len(sides) > 1:
            what = f"{self.file} has events of both sides"
            raise InputError("", "`cycle_side`", what, "say whose cycles count: right or left")
        side = self.side or next(iter(sides), "right")
        found = cycles_between(own, recording, side, self.part)
        if not found:
            needs = f"a {STRIKE} and an {OFF} after it" if self.part == STANCE else f"two times of {STRIKE}"
            known = ", ".join(sorted({each.recording for each in self.events if each.recording})) or "none named"
            what = f"no cycle of the {side} side in recording {recording!r} (recordings: {known})"
            raise InputError(self.file, "", what, f"a cycle takes {needs}")
        for style in sorted({each.style for each in found}):
            lasts = [each.end - each.start for each in found if each.style == style]
            if max(lasts) > UNEVEN * min(lasts):
                name = f"cycles of {style} in {recording}" if style else f"cycles of {recording}"
                what = f"{name} last {min(lasts):.3g} to {max(lasts):.3g} s"
                reserve(f"{self.file}: {what}: is a {STRIKE} missing, or one too many?")
        return found

    def trials_of(
        self, recording: str, time: Float[np.ndarray, " t"], columns: Mapping[str, Float[np.ndarray, " t"]]
    ) -> Trials:
        """Each channel over 0, 1, … 100 % of every cycle of a recording; those outside of it are left out and said."""
        cycles = self.cycles_of(recording)
        inside = [each for each in cycles if time[0] - SLACK <= each.start and each.end <= time[-1] + SLACK]
        if not inside:
            span = f"{time[0]:g} to {time[-1]:g} s"
            what = f"no cycle of recording {recording!r} lies within it, {span}"
            raise InputError(self.file, "", what, "are the clocks the same?")
        if len(inside) < len(cycles):
            out = len(cycles) - len(inside)
            reserve(f"{self.file}: {out} of {len(cycles)} cycles of {recording} reach beyond the recording: left out")
        found: Trials = {}
        for name, values in columns.items():
            for each in inside:
                curve = normalised(time, values, max(each.start, float(time[0])), each.end)
                known = found.setdefault(name, {}).get(each.style, np.zeros((0, len(STEPS))))
                found[name][each.style] = np.vstack([known, curve])
        return found


def together(parts: Sequence[Trials]) -> Trials:
    """Cycles of several recordings; those of one style stand together."""
    found: Trials = {}
    for part in parts:
        for name, styles in part.items():
            for style, rows in styles.items():
                known = found.setdefault(name, {}).get(style, np.zeros((0, len(STEPS))))
                found[name][style] = np.vstack([known, rows])
    return found


def cycle_ensemble(trials: Trials) -> pd.DataFrame:
    """Mean and SD of every channel and style at each per cent; the SD is empty where a style has one cycle."""
    parts = []
    for name, styles in trials.items():
        for style, rows in styles.items():
            mean, sd = mean_and_sd(rows)
            told = {**quantity_of(name), "style": style, "cycle [%]": STEPS, "cycles [-]": len(rows)}
            parts.append(pd.DataFrame({**told, "mean": mean, "sd": sd}))
    return pd.concat(parts, ignore_index=True)


def shifts_between(trials: Trials) -> pd.DataFrame:
    """Every further style beside the first, channel by channel: RMSE of the means, swing, peak, and how much later.

    Values are in the unit of the row, shifts in % of the cycle; intervals of 95 % from three cycles of each on. Empty
    where there is one style.
    """
    rows: list[dict[str, object]] = []
    for name, styles in trials.items():
        first, *others = styles or ("",)
        for style in others:
            found = style_shift(styles[style], styles[first])
            row: dict[str, object] = {**quantity_of(name), "style": style, "reference": first}
            row |= {"cycles [-]": len(styles[style]), "reference_cycles [-]": len(styles[first])}
            row["rmse"] = rms_difference(styles[style].mean(axis=0), styles[first].mean(axis=0))
            for key, unit, each in (
                ("peak_to_peak_difference", "", found.swing),
                ("peak_difference", "", found.peak),
                ("later", " [%]", found.later),
                ("peak_later", " [%]", found.peak_later),
            ):
                row |= {f"{key}{unit}": each.value, f"{key}_lower{unit}": each.lower, f"{key}_upper{unit}": each.upper}
            rows.append({**row, "correlation [-]": found.correlation})
    return pd.DataFrame(rows)


def cycle_tables(trials: Trials) -> dict[str, pd.DataFrame]:
    """`cycles`, and `shifts` where there are several styles."""
    shifts = shifts_between(trials)
    found = {"cycles": cycle_ensemble(trials)}
    return {**found, "shifts": shifts} if len(shifts) else found


def quantity_of(column: str) -> dict[str, str]:
    """Name and unit of a column, apart."""
    name, unit = split_header(column)
    return {"quantity": name, "unit": unit}

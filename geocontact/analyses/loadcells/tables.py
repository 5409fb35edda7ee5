"""Tables of the cycles: their times and peaks, their mean, and how styles differ."""

from __future__ import annotations

import pandas as pd

from geocontact.analyses.loadcells.cycles import SIDES, Cut, stacked
from geocontact.data.ensemble import mean_and_sd
from geocontact.identify.signals.cycles import STEPS
from geocontact.identify.signals.ensemble import rms_difference
from geocontact.identify.signals.style_shift import style_shift


def cycle_table(cuts: list[Cut]) -> pd.DataFrame:
    """A row per cycle with its largest forces."""
    rows: list[dict[str, object]] = [
        {
            "style": cut.style,
            "recording": cut.recording,
            "start [s]": cut.span.start,
            "end [s]": cut.span.end,
            **{f"peak_{side} [N]": float(cut.curves[side].max()) for side in SIDES},
        }
        for cut in cuts
    ]
    return pd.DataFrame(rows)


def ensemble_table(cuts: list[Cut]) -> pd.DataFrame:
    """Mean and SD of every style at each per cent; the SD is empty where a style has one cycle."""
    parts = []
    for style, trials in stacked(cuts, "total").items():
        columns: dict[str, object] = {"style": [style] * len(STEPS), "cycle [%]": STEPS, "cycles [-]": len(trials)}
        for side in SIDES:
            mean, sd = mean_and_sd(stacked(cuts, side)[style])
            columns |= {f"{side}_mean [N]": mean, f"{side}_sd [N]": sd}
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def style_table(cuts: list[Cut]) -> pd.DataFrame:
    """Root mean square difference of every further style's mean to that of the first."""
    rows: list[dict[str, object]] = []
    first, *others = dict.fromkeys(cut.style for cut in cuts)
    means = {side: {s: mean_and_sd(t)[0] for s, t in stacked(cuts, side).items()} for side in SIDES}
    for style in others:
        off = {f"rmse_{side} [N]": rms_difference(means[side][style], means[side][first]) for side in SIDES}
        rows.append({"style": style, "reference": first, **off})
    return pd.DataFrame(rows)


def shift_table(cuts: list[Cut]) -> pd.DataFrame:
    """How much more every further style swings than the first, and how much later it is, with intervals of 95 %."""
    rows: list[dict[str, object]] = []
    first, *others = dict.fromkeys(cut.style for cut in cuts)
    for style in others:
        for side in SIDES:
            curves = stacked(cuts, side)
            found = style_shift(curves[style], curves[first])
            row: dict[str, object] = {"style": style, "reference": first, "side": side}
            row["cycles [-]"], row["reference_cycles [-]"] = len(curves[style]), len(curves[first])
            for name, unit, told in (
                ("peak_to_peak_difference", "N", found.swing),
                ("peak_difference", "N", found.peak),
                ("later", "%", found.later),
                ("peak_later", "%", found.peak_later),
            ):
                row |= {f"{name} [{unit}]": told.value}
                row |= {f"{name}_{end} [{unit}]": getattr(told, end) for end in ("lower", "upper")}
            rows.append({**row, "correlation [-]": found.correlation})
    return pd.DataFrame(rows)

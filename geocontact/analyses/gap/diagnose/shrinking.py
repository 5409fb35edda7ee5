"""How far the error shrinks, in words: on the trials that were held out, and what is expected of a new one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.analyses.frame.words import counted
from geocontact.analyses.gap.case import percent
from geocontact.data.diagnosis import ChannelGap
from geocontact.view.curves.sheet import number

PRINTED = {"N m": ("N m", 1.0), "N": ("N", 1.0), "m": ("mm", 1e3), "rad": ("°", 180.0 / np.pi)}
FEW_TRIALS = 2  # held out, that may leave an interval wide
BROAD = 0.3  # width of an interval of a reduction from which the few trials are named as its cause
SILENT = 0.6  # from which an interval shows nothing of how far, and is not printed


def printed(unit: str) -> tuple[str, float]:
    """A unit as it is shown, and how many of it one of the SI unit is; rates likewise."""
    if unit.endswith("/s") and unit[:-2] in PRINTED:
        name, per_si = PRINTED[unit[:-2]]
        return f"{name}/s", per_si
    return PRINTED.get(unit, (unit, 1.0))


def interval(ci95: tuple[float, float]) -> str:
    """ "−3 to 95 %"."""
    return f"{percent(ci95[0])} to {percent(ci95[1])} %"


def telling(ci95: tuple[float, float]) -> bool:
    """Whether an interval of a reduction shows how far, and is printed; diagnosis.json has it either way."""
    return ci95[1] - ci95[0] <= SILENT


def axis_words(axis: str) -> str:
    """An axis of the gap map in words: "rate of angle" of "angle'"."""
    return f"rate of {axis.rstrip(chr(39))}" if axis.endswith("'") else axis


def held_out_words(gap: ChannelGap) -> str:
    """ "on the 2 held-out trials", or "on the held-out trials" where nobody counted them."""
    if not gap.trials:
        return "on the held-out trials"
    return f"on the {counted(gap.trials, 'held-out trial')}" if gap.trials > 1 else "on the held-out trial"


def sizes_words(gap: ChannelGap) -> str:
    """ "3.85 → 0.20 N m, noise floor 0.20": root mean squares on the held-out trials."""
    unit, per_si = printed(gap.unit)
    sizes = (gap.rmse_before, gap.rmse_after, gap.noise_floor)
    before, after, floor = (number(per_si * size, per_si * gap.rmse_before) for size in sizes)
    return f"{before} → {after} {unit}".strip() + f", noise floor {floor}"


def removed_words(gaps: Mapping[str, ChannelGap]) -> str:
    """What is removed on the held-out trials, channel by channel."""
    parts: list[str] = []
    for name, gap in gaps.items():
        what = "that" if parts else "the error"
        of = f" of {name}" if len(gaps) > 1 else ""
        parts.append(f"{percent(gap.removed)} % of {what}{of} ({sizes_words(gap)})")
    return ", ".join(parts)


def expected_words(gaps: Mapping[str, ChannelGap]) -> str:
    """What is expected of a new trial, channel by channel; why an interval is wide where few trials are the cause.

    An interval wider than `SILENT` is not printed: diagnosis.json has it.
    """
    parts: list[str] = []
    for name, gap in gaps.items():
        of = f" for {name}" if len(gaps) > 1 else ""
        if not telling(gap.ci95):
            many = counted(gap.trials, "held-out trial") if gap.trials else "the held-out trials"
            parts.append(
                f"{many} {'does' if gap.trials == 1 else 'do'} not show how far the error shrinks{of}: record more"
            )
        else:
            parts.append(f"{percent(gap.reduction)} % expected{of}, 95 % interval {interval(gap.ci95)}")
    widths = {name: gap.ci95[1] - gap.ci95[0] for name, gap in gaps.items()}
    wide = [g for name, g in gaps.items() if BROAD < widths[name] <= SILENT and 0 < g.trials <= FEW_TRIALS]
    if wide:
        count = min(gap.trials for gap in wide)
        there = f"{'is' if count == 1 else 'are'} {counted(count, 'held-out trial')}"
        parts.append(f"the interval is wide because there {there}: record more")
    return "; ".join(parts)

"""What is shown of a comparison: a figure for each channel, and the page of the trial with the largest error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.compare.pairs import QUANTITIES, Pair
from geocontact.analyses.misalignment.page import FRAMES, NOT_IN_THE_NUMBERS, elbow_page
from geocontact.data.motion import Course
from geocontact.view.curves.declared import INK, Curve, Curves, Points, stroke
from geocontact.view.page.content import (
    IntervalRow,
    Intervals,
    Page,
    Readout,
    Row,
    Section,
    Table,
)

NAMED = 4
"""Trials that the legend names, a colour each."""


def channel_curves(pairs: Sequence[Pair], width: float) -> Curves:
    """One channel over the angle in bins of this width [rad], a colour per trial: measured as marks, the model as
    lines.
    """
    q = QUANTITIES[pairs[0].channel]
    marks, lines = [], []
    for k, pair in enumerate(pairs):
        angle, measured, model = pair.binned(width).T
        names = [f"{pair.trial}, {what}" if k < NAMED else "" for what in ("measured", "by the model")]
        marks.append(Points(names[0], np.degrees(angle), q.per_si * measured, stroke(k % NAMED)))
        lines.append(Points(names[1], np.degrees(angle), q.per_si * model, stroke(k % NAMED, k // NAMED), joined=True))
    reach = np.concatenate([mark.time for mark in marks])
    over = Course("exoskeleton angle β", "°", np.array([reach.min(), reach.max()]))
    title = f"{q.name.capitalize()} over the angle"
    return Curves(title, q.unit, [], points=[*marks, *lines], over=over, words=COMPARED)


COMPARED = "Means over bins of the angle: measured as marks, the model as lines, a colour per trial."


def comparison_page(pairs: Sequence[Pair], channels: Sequence[Curves], tables: Sequence[Table]) -> Page:
    """The page of a comparison, the trial with the largest error over time.

    `channels` are those of `channel_curves`.
    """
    first = max((p for p in pairs if p.channel == pairs[0].channel), key=lambda p: p.agreement.rmsd)
    shown = slice(None, None, -(-len(first.time) // FRAMES))
    q = QUANTITIES[first.channel]
    both = {"measured": q.per_si * first.measured[shown], "model": q.per_si * first.model[shown]}
    off = both["model"] - both["measured"]
    rows = {**both, "model less measured": off}
    name = f"{q.name.capitalize()}, {first.trial}"
    sections: list[Section] = [
        Curves(
            name,
            q.unit,
            [Curve(each, values, stroke=own) for (each, values), own in zip(both.items(), (INK, 0), strict=True)],
        ),
        *_errors(pairs),
        Curves(f"{name}: model less measured", q.unit, [Curve("error", off, stroke=1)]),
        Readout([Row(each, q.unit, [f"{v:.2f}" for v in values]) for each, values in rows.items()]),
        *channels,
        *tables,
        INPUTS,
        OPTIONS,
        NOT_IN_THE_NUMBERS,
    ]
    title = f"Model against {counted(len({p.trial for p in pairs}), 'recording')}"
    subtitle = "Model and measurement of an elbow exoskeleton"
    facts = [(f"{p.trial}, {p.channel}", f"{_rmse(p)}, R² {p.agreement.r2:.3f}") for p in pairs]
    time = first.time[shown]
    return elbow_page(title, subtitle, time, "time [s]", answer(pairs), facts, sections)


def answer(pairs: Sequence[Pair]) -> list[str]:
    """How far the model is from each channel, in the best and in the worst trial."""
    return [_channel(sorted(mine, key=lambda p: p.agreement.rmsd)) for mine in _by_channel(pairs)]


def _channel(mine: Sequence[Pair]) -> str:
    what, best, worst = QUANTITIES[mine[0].channel].name, mine[0], mine[-1]
    told = f"The model misses the {what} by {_rmse(best)} root mean square in {best.trial} (R² {best.agreement.r2:.3f})"
    if worst is best:
        return f"{told}."
    many = f", the worst of {len(mine)} trials" if len(mine) > 2 else ""
    return f"{told} and by {_rmse(worst)} in {worst.trial} (R² {worst.agreement.r2:.3f}){many}."


def _errors(pairs: Sequence[Pair]) -> list[Section]:
    """Bars of both errors of every trial, a drawing for each channel."""
    found: list[Section] = []
    for mine in _by_channel(pairs):
        q = QUANTITIES[mine[0].channel]
        rows = [
            IntervalRow(p.trial, q.per_si * size, kind=kind)
            for p in mine
            for kind, size in (("root mean square", p.agreement.rmsd), ("mean absolute", p.agreement.mae))
        ]
        found.append(Intervals(f"Error of the {q.name}", q.unit, rows, bars=True))
    return found


def _by_channel(pairs: Sequence[Pair]) -> list[list[Pair]]:
    return [mine for channel in QUANTITIES if (mine := [p for p in pairs if p.channel == channel])]


def _rmse(p: Pair) -> str:
    q = QUANTITIES[p.channel]
    return f"{q.per_si * p.agreement.rmsd:.3g} {q.unit}"

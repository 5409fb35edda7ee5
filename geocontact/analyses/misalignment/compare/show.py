"""What is shown of a comparison: a figure for each channel, and the page of the trial with the largest error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.compare.pairs import QUANTITIES, Pair
from geocontact.analyses.misalignment.page import ANGLE, FRAMES, NOT_IN_THE_NUMBERS, elbow_page
from geocontact.view.curves.quantity import FORCE, Quantity
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import DOUBLE, GREY, LINES, MARKERS, PALETTE, in_style, legend, panels
from geocontact.view.page.content import (
    Curve,
    Curves,
    IntervalRow,
    Intervals,
    Page,
    Picture,
    Readout,
    Row,
    Section,
    Table,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


Entries = list[tuple["Artist | tuple[Artist, ...]", str]]


@in_style
def comparison_figure(
    names: Sequence[str],
    beta: Sequence[Float[np.ndarray, " _"]],
    measured: Sequence[Float[np.ndarray, " _"]],
    model: Sequence[Float[np.ndarray, " _"]],
    quantity: Quantity = FORCE,
) -> Figure:
    """Draw one channel over the angle in bins, a colour per trial: measured as marks, the model as lines."""
    figure, (axes,) = panels(1, 1, DOUBLE, 0.08)
    entries: Entries = []
    for k, (name, b, m, s) in enumerate(zip(names, beta, measured, model, strict=True)):
        colour = PALETTE[k % len(PALETTE)]
        dots = axes.plot(np.degrees(b), quantity.shown(m), MARKERS[k % len(MARKERS)], color=colour, markersize=2.5)[0]
        line = axes.plot(np.degrees(b), quantity.shown(s), color=colour, ls=LINES[k % len(LINES)])[0]
        if k < len(PALETTE):
            entries.append(((dots, line), plain(name)))
    axes.axhline(0.0, color=GREY, lw=0.6)
    axes.set_xlabel(ANGLE)
    axes.set_ylabel(quantity.label)
    legend(axes, entries)
    return figure


COMPARED = "Means over bins of the angle: measured as marks, the model as lines, a colour per trial."


def comparison_page(pairs: Sequence[Pair], drawings: Mapping[str, bytes], tables: Sequence[Table]) -> Page:
    """The page of a comparison, the trial with the largest error over time.

    `drawings` are the SVG of each channel's figure.
    """
    first = max((p for p in pairs if p.channel == pairs[0].channel), key=lambda p: p.agreement.rmsd)
    shown = slice(None, None, -(-len(first.time) // FRAMES))
    q = QUANTITIES[first.channel]
    both = {"measured": q.per_si * first.measured[shown], "model": q.per_si * first.model[shown]}
    off = both["model"] - both["measured"]
    rows = {**both, "model less measured": off}
    name = f"{q.name.capitalize()}, {first.trial}"
    sections: list[Section] = [
        Curves(name, q.unit, [Curve(each, values) for each, values in both.items()]),
        *_errors(pairs),
        Curves(f"{name}: model less measured", q.unit, [Curve("error", off, stroke=1)]),
        Readout([Row(each, q.unit, [f"{v:.2f}" for v in values]) for each, values in rows.items()]),
        *(Picture(QUANTITIES[each].name.capitalize(), COMPARED, svg, wide=True) for each, svg in drawings.items()),
        *tables,
        INPUTS,
        OPTIONS,
        NOT_IN_THE_NUMBERS,
    ]
    title = f"Model beside {counted(len({p.trial for p in pairs}), 'recording')}"
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

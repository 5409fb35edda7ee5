"""The static figure of declared curves: the same strokes, marks and spans as on the page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.motion import Course
from geocontact.view.curves.declared import DASHES, Curves, Points
from geocontact.view.curves.quantity import WRAP
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import BLACK, COLOURS, DOUBLE, GREY, in_style, legend, panels
from geocontact.view.extremes import thinned_line

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HUES = (*COLOURS, BLACK)
"""Colours of strokes, those of the page."""
LINES: tuple[tuple[float, ...], ...] = (
    (),
    (3.5, 1.5),
    (1.0, 1.5),
    (4.5, 1.5, 1.0, 1.5),
    (8.0, 2.0),
    (0.5, 3.5),
    (4.5, 1.5, 1.0, 1.5, 1.0, 1.5),
    (8.0, 2.0, 2.5, 2.0),
)
"""Dashes of strokes in widths of the line, those of the page; a test compares both."""
MARKS = "os^"
"""Marks of points by their place, those of the page."""
TALL, LOW = 0.056, 0.046
"""Height of a row of panels [m]: alone, and among others."""
MANY = 6
"""Panels above which three stand in a row."""
NAMED = 8
"""Curves of a panel that its legend names at most."""

Entries = list[tuple["Artist | tuple[Artist, ...]", str]]


@in_style
def drawn(panels_shown: Sequence[Curves], over: Course | None = None, columns: int | None = None) -> Figure:
    """Draw a panel for each set of curves, all `over` one axis unless a panel has its own.

    Parameters
    ----------
    over
        Along what curves run that have no axis of their own.
    columns
        Panels in a row; one, two or three by their number unless given.

    Returns
    -------
    Figure
        Two columns wide, for `view.curves.style.save`.
    """
    if not panels_shown:
        raise ValueError("no curves to draw")
    count = len(panels_shown)
    wide = columns or (1 if count == 1 else 2 if count <= MANY else 3)
    rows = -(-count // wide)
    alike = _alike(panels_shown)
    figure, axes = panels(rows, wide, DOUBLE, TALL + LOW * (rows - 1) + 0.008 * rows)
    for k, (panel, own) in enumerate(zip(panels_shown, axes, strict=False)):
        entries = _curves(own, panel, over)
        if not alike:
            legend(own, entries) if entries else None
        elif k == 0:
            handles, names = zip(*entries, strict=True)
            figure.legend(handles, [plain(name, 110) for name in names], loc="outside upper center", ncols=len(names))
    for spare in axes[count:]:
        spare.remove()
    return figure


@in_style
def draw_on(axes: Axes, panel: Curves, over: Course | None = None) -> None:
    """Draw one panel with its legend on axes that are there, such as those beside a map."""
    entries = _curves(axes, panel, over)
    if entries:
        legend(axes, entries)


def _alike(panels_shown: Sequence[Curves]) -> bool:
    """Whether one legend says what is in every panel."""
    named = {tuple((c.name, _stroke(c.stroke, k)) for k, c in enumerate(p.curves) if not c.thin) for p in panels_shown}
    others = any(p.points or p.limits or p.spans for p in panels_shown)
    return len(panels_shown) > 1 and len(named) == 1 and 1 < len(next(iter(named))) <= 4 and not others


def _curves(axes: Axes, panel: Curves, over: Course | None) -> Entries:
    """Everything of a panel but its legend, whose entries are returned."""
    along = panel.over or over
    if along is None:
        raise ValueError(f"{panel.title}: along what do its curves run?")
    entries: Entries = []
    x = along.values  # noqa: PD011
    for k, curve in enumerate(panel.curves):
        look = _look(_stroke(curve.stroke, k))
        band = None
        if curve.lower is not None and curve.upper is not None:
            band = axes.fill_between(x, curve.lower, curve.upper, color=look["color"], alpha=0.2, lw=0)
        if curve.thin:
            axes.plot(*thinned_line(x, curve.values), color=look["color"], lw=0.5, alpha=0.6, zorder=2)
            continue
        line = axes.plot(*thinned_line(x, curve.values), **look, zorder=3)[0]
        _alone(axes, x, curve.values, look["color"])
        entries.append((line if band is None else (band, line), curve.name))
    entries = entries if len(entries) <= NAMED else []
    if len(entries) == 1 and entries[0][1].lower() in panel.title.lower():
        entries = []  # the axis says it
    entries += [_points(axes, points, k) for k, points in enumerate(panel.points)]
    for limit in panel.limits:
        entries.append((axes.axhline(limit.value, color=BLACK, lw=0.8, ls="--"), limit.name))
    entries += _spans(axes, panel)
    _frame(axes, panel, along)
    return entries


def _alone(axes: Axes, x: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], colour: str) -> None:
    """Samples between two gaps, which no line reaches."""
    known = np.concatenate([[False], np.isfinite(values), [False]])
    single = known[1:-1] & ~known[:-2] & ~known[2:]
    if single.any():
        axes.plot(x[single], values[single], ".", color=colour, markersize=2.5)


def _points(axes: Axes, points: Points, k: int) -> tuple[Artist, str]:
    if points.joined:
        look = _look(_stroke(points.stroke, k))
        mark = "." if len(points.time) == 1 else None
        return axes.plot(points.time, points.values, marker=mark, **look)[0], points.name
    colour = BLACK if points.stroke is None else HUES[points.stroke % len(HUES)]
    mark = MARKS[k % len(MARKS)]
    dots = axes.plot(
        points.time, points.values, mark, color=colour, markersize=3.0, markerfacecolor="white", markeredgewidth=0.8
    )
    return dots[0], points.name


def _spans(axes: Axes, panel: Curves) -> Entries:
    """Shaded stretches and lines; those that follow each other are shaded in turns."""
    named: dict[str, Artist] = {}
    for k, span in enumerate(panel.spans):
        if span.start == span.end:
            artist: Artist = axes.axvline(span.start, color=GREY, lw=0.8, ls="-.")
        else:
            artist = axes.axvspan(span.start, span.end, color=GREY, alpha=0.24 if k % 2 else 0.14, lw=0, zorder=0)
        named.setdefault(span.name, artist)
    return [(artist, name) for name, artist in named.items() if name]


def _frame(axes: Axes, panel: Curves, along: Course) -> None:
    """Axes, their labels and a line at zero."""
    known = along.values[np.isfinite(along.values)]
    if len(known) > 1 and known[0] != known[-1] and not any(points.joined for points in panel.points):
        axes.set_xlim(known[0], known[-1])
    if panel.log:
        axes.set_yscale("log")
    else:
        low, high = axes.get_ylim()
        if low < 0.0 < high:
            axes.axhline(0.0, color=GREY, lw=0.6, zorder=1)
    axes.set_xlabel(plain(along.label, WRAP))
    axes.set_ylabel(plain(f"{panel.title} [{panel.unit or '–'}]", WRAP))
    if panel.beside is not None:
        factor = panel.beside.factor
        other = axes.secondary_yaxis("right", functions=(lambda y: y * factor, lambda y: y / factor))
        other.set_ylabel(f"[{plain(panel.beside.unit)}]")


def _stroke(given: int | None, place: int) -> int:
    return place if given is None else given


def _look(number: int) -> dict[str, object]:
    dashes = LINES[number % DASHES]
    return {"color": HUES[number % len(HUES)], "ls": (0, dashes) if dashes else "-"}

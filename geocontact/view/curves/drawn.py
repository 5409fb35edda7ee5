"""The static figure of declared curves: the same strokes, marks and spans as on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from geocontact.data.motion import Course
from geocontact.view.curves.declared import DASHES, Curves, CurveSheet, Points
from geocontact.view.curves.quantity import WRAP
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.strokes import assigned, lines_of, with_strokes
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
TALL, LOW, LOWEST = 0.056, 0.046, 0.038
"""Height of a row of panels [m]: alone, among others, among more than `ROWS`."""
ROWS = 4
ROUNDED = 0.1
"""Part of a decade that the margin of an axis may take."""
WORDS = 82
"""Letters that stand side by side in the width of a figure."""
MANY = 6
"""Panels above which three stand in a row."""
NAMED = 8
"""Curves of a panel that its legend names at most."""

SHARED = 10
"""Entries of a legend of all panels at most."""
HANDLE = 8
"""Width of a line and its distances in a legend, in letters."""


@dataclass(frozen=True, eq=False)
class LegendEntry:
    """What a legend says of a line, a mark or a span; `look` tells those apart that look alike."""

    artist: Artist | tuple[Artist, ...]
    name: str
    look: tuple[object, ...]


@in_style
def drawn(sheet: CurveSheet) -> Figure:
    """Draw a panel for each set of curves, two columns wide, for `view.curves.style.save`."""
    count = len(sheet.panels)
    if not count:
        raise ValueError("no curves to draw")
    wide = sheet.columns or (1 if count == 1 else 2 if count <= MANY else 3)
    rows = -(-count // wide)
    height = 0.012 + (TALL if rows == 1 else rows * ((LOW if rows <= ROWS else LOWEST) + 0.008))
    figure, axes = panels(rows, wide, DOUBLE, height)
    strokes = assigned([lines_of(panel) for panel in sheet.panels])
    shown = [with_strokes(panel, own) for panel, own in zip(sheet.panels, strokes, strict=True)]
    entries = [_curves(own, panel, sheet.over) for panel, own in zip(shown, axes, strict=False)]
    shared = _shared(entries) if count > 1 else None
    if shared:
        names = [plain(entry.name, WORDS) for entry in shared]
        columns = max(1, min(len(names), WORDS // (max(map(len, names)) + HANDLE)))
        handles: list[Any] = [entry.artist for entry in shared]  # a pair of band and line is one, too
        figure.legend(handles, names, loc="outside upper center", ncols=columns)
    for panel, own, found in zip(sheet.panels, axes, entries, strict=False):
        _head(own, panel, found if shared is None else ())
    for spare in axes[count:]:
        spare.remove()
    return figure


@in_style
def draw_on(axes: Axes, panel: Curves, over: Course | None = None) -> None:
    """Draw one panel with its legend on axes that are there, such as those beside a map."""
    shown = with_strokes(panel, *assigned([lines_of(panel)]))
    _head(axes, panel, _curves(axes, shown, over))


def _head(axes: Axes, panel: Curves, entries: Sequence[LegendEntry]) -> None:
    """Title of a panel, and below it what is drawn."""
    grid = axes.get_subplotspec()
    title = plain(panel.title, WORDS // (grid.get_gridspec().ncols if grid is not None else 1))
    if entries:
        legend(axes, [(entry.artist, entry.name) for entry in entries], title)
    else:
        axes.set_title(title, loc="left")


def _shared(panels_shown: Sequence[Sequence[LegendEntry]]) -> list[LegendEntry] | None:
    """What one legend says of all panels; None where a name or a look means several things, or where it is long."""
    found = list({(entry.name, entry.look): entry for entries in panels_shown for entry in entries}.values())
    unique = len({entry.name for entry in found}) == len({entry.look for entry in found}) == len(found)
    return found if unique and len(found) <= SHARED else None


def _curves(axes: Axes, panel: Curves, over: Course | None) -> list[LegendEntry]:
    """Everything of a panel but its legend, whose entries are returned."""
    along = panel.over or over
    if along is None:
        raise ValueError(f"{panel.title}: along what do its curves run?")
    entries: list[LegendEntry] = []
    x = along.values
    for k, curve in enumerate(panel.curves):
        number = _stroke(curve.stroke, k)
        look = _look(number)
        band = None
        if curve.lower is not None and curve.upper is not None:
            band = axes.fill_between(x, curve.lower, curve.upper, color=look["color"], alpha=0.2, lw=0)
        if curve.thin:
            axes.plot(*thinned_line(x, curve.values), color=look["color"], lw=0.5, alpha=0.6, zorder=2)
            continue
        line = axes.plot(*thinned_line(x, curve.values), **look, zorder=3)[0]
        _alone(axes, x, curve.values, look["color"])
        entries.append(
            LegendEntry(line if band is None else (band, line), curve.name, (number % (len(HUES) * DASHES),))
        )
    entries = entries if len(entries) <= NAMED else []
    if len(entries) == 1 and entries[0].name.lower() in panel.title.lower():
        entries = []  # the axis says it
    entries += [entry for k, points in enumerate(panel.points) if (entry := _points(axes, points, k)).name]
    for limit in panel.limits:
        entries.append(LegendEntry(axes.axhline(limit.value, color=BLACK, lw=0.8, ls="--"), limit.name, ("limit",)))
    entries += _spans(axes, panel)
    _frame(axes, panel, along)
    return entries


def _alone(axes: Axes, x: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], colour: str) -> None:
    """Samples between two gaps, which no line reaches."""
    known = np.concatenate([[False], np.isfinite(values), [False]])
    single = known[1:-1] & ~known[:-2] & ~known[2:]
    if single.any():
        axes.plot(x[single], values[single], ".", color=colour, markersize=2.5)


def _points(axes: Axes, points: Points, k: int) -> LegendEntry:
    if points.joined:
        number = _stroke(points.stroke, k)
        mark = "." if len(points.time) == 1 else None
        line = axes.plot(points.time, points.values, marker=mark, **_look(number))[0]
        return LegendEntry(line, points.name, (number % (len(HUES) * DASHES),))
    colour = BLACK if points.stroke is None else HUES[points.stroke % len(HUES)]
    mark = MARKS[k % len(MARKS)]
    dots = axes.plot(
        points.time, points.values, mark, color=colour, markersize=3.0, markerfacecolor="white", markeredgewidth=0.8
    )
    return LegendEntry(dots[0], points.name, (mark, colour))


def _spans(axes: Axes, panel: Curves) -> list[LegendEntry]:
    """Shaded stretches and lines; those that follow each other are shaded in turns."""
    named: dict[str, Artist] = {}
    for k, span in enumerate(panel.spans):
        if span.start == span.end:
            artist: Artist = axes.axvline(span.start, color=GREY, lw=0.8, ls="-.")
        else:
            artist = axes.axvspan(span.start, span.end, color=GREY, alpha=0.24 if k % 2 else 0.14, lw=0, zorder=0)
        named.setdefault(span.name, artist)
    return [LegendEntry(artist, name, (type(artist).__name__,)) for name, artist in named.items() if name]


def _frame(axes: Axes, panel: Curves, along: Course) -> None:
    """Axes, their labels and a line at zero."""
    known = along.values[np.isfinite(along.values)]
    if len(known) > 1 and known[0] != known[-1] and not any(points.joined for points in panel.points):
        axes.set_xlim(known[0], known[-1])
    if panel.log:
        axes.set_yscale("log")
        low, high = np.log10(axes.get_ylim())
        axes.set_ylim(10.0 ** np.floor(low + ROUNDED), 10.0 ** np.ceil(high - ROUNDED))  # whole decades, as on the page
        axes.yaxis.set_minor_formatter(lambda *_: "")
    else:
        low, high = axes.get_ylim()
        if low < 0.0 < high:
            axes.axhline(0.0, color=GREY, lw=0.6, zorder=1)
    axes.set_xlabel(plain(along.label, WRAP))
    axes.set_ylabel(f"[{plain(panel.unit or '–')}]")
    if panel.beside is not None:
        factor = panel.beside.factor
        both = lambda y: np.asarray(y) * factor, lambda y: np.asarray(y) / factor
        other = axes.secondary_yaxis("right", functions=both)
        other.set_ylabel(f"[{plain(panel.beside.unit)}]")


def _stroke(given: int | None, place: int) -> int:
    return place if given is None else given


def _look(number: int) -> dict[str, Any]:
    dashes = LINES[number % DASHES]
    return {"color": HUES[number % len(HUES)], "ls": (0, dashes) if dashes else "-"}

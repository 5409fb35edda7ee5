"""Sets of curves as they are declared: once, for the page that draws them and for the static figure of the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.motion import Course
from geocontact.data.trial import mean_and_sd
from geocontact.view.extremes import FRAMES, with_extremes

HUES, DASHES = 5, 8
"""Colours and kinds of dashes; a stroke's number gives both, by its remainders."""


def stroke(colour: int, dashes: int = 0) -> int:
    """Number of the stroke of this colour (0 blue, 1 orange, 2 green, 3 pink, 4 ink) and these dashes (0: none)."""
    return (16 * colour + 25 * dashes) % (HUES * DASHES)  # 16 is 1 and 0, 25 is 0 and 1 in the two remainders


INK = stroke(4)
"""What was measured, and what all else is compared with."""


@dataclass(frozen=True, eq=False)
class Curve:
    """One line over time in the unit of its panel, with a band where bounds are known; NaN is a gap.

    `stroke` is the number of its colour and dashes, its place by default: one thing looks alike in all panels.
    `thin` is one of many lines that the key does not name, such as a single cycle.
    """

    name: str
    values: Float[np.ndarray, " t"]
    lower: Float[np.ndarray, " t"] | None = None
    upper: Float[np.ndarray, " t"] | None = None
    stroke: int | None = None
    thin: bool = False

    def at(self, kept: Int[np.ndarray, " k"]) -> Curve:
        """The curve at some of its samples."""
        lower, upper = (None if each is None else each[kept] for each in (self.lower, self.upper))
        return replace(self, values=self.values[kept], lower=lower, upper=upper)


@dataclass(frozen=True, eq=False)
class Points:
    """Values known at places of their own, such as measured ones: marks beside the curves, or `joined` to a line.

    Marks are in ink, a line has the colour of its place, unless `stroke` gives another. The key leaves out names of "".
    """

    name: str
    time: Float[np.ndarray, " k"]
    values: Float[np.ndarray, " k"]
    stroke: int | None = None
    joined: bool = False


@dataclass(frozen=True)
class Limit:
    """A level line across a panel, in its unit."""

    name: str
    value: float


@dataclass(frozen=True)
class Shade:
    """A shaded stretch along the panel's axis, a line where both ends are one; spans of one name are one in the key."""

    name: str
    start: float
    end: float


@dataclass(frozen=True)
class Scale:
    """A second axis of a panel: its unit, and what 1 in the panel's unit is in it."""

    unit: str
    factor: float


@dataclass(frozen=True, eq=False)
class Curves:
    """A panel of curves with one axis, marks, level lines and spans.

    Parameters
    ----------
    beside
        A second scale of the same values.
    over
        Along what the curves run, if not along that of the page: the cycle beside time.
    log
        The axis of the values is logarithmic.
    words
        What the panel shows.
    """

    title: str
    unit: str
    curves: Sequence[Curve]
    points: Sequence[Points] = ()
    limits: Sequence[Limit] = ()
    beside: Scale | None = None
    spans: Sequence[Shade] = ()
    over: Course | None = None
    log: bool = False
    words: str = ""

    def __post_init__(self) -> None:
        if self.over is not None:
            for curve in self.curves:
                if len(curve.values) != len(self.over.values):
                    count = len(self.over.values)
                    raise ValueError(f"curve {curve.name}: {len(curve.values)} values over {count} of {self.over.name}")

    def at(self, kept: Int[np.ndarray, " k"]) -> Curves:
        """The panel at some of the page's frames; one with an axis of its own as it is."""
        return self if self.over is not None else replace(self, curves=[curve.at(kept) for curve in self.curves])

    def bounded(self, most: int = FRAMES) -> Curves:
        """The panel with about `most` samples of what runs along an axis of its own: those with the extremes."""
        points = [_fewer(each, most) for each in self.points]
        if self.over is None or len(self.over.values) <= most:
            return replace(self, points=points)
        kept = with_extremes(len(self.over.values), [curve.values for curve in self.curves], most)
        over = replace(self.over, values=self.over.values[kept])
        return replace(self, curves=[curve.at(kept) for curve in self.curves], points=points, over=over)


def _fewer(points: Points, most: int) -> Points:
    if len(points.time) <= most:
        return points
    kept = with_extremes(len(points.time), [points.values], most)
    return replace(points, time=points.time[kept], values=points.values[kept])


@dataclass(frozen=True, eq=False)
class CurveSheet:
    """Panels that belong together: a static figure, and cards of the page.

    Parameters
    ----------
    over
        Along what the panels run that have no axis of their own: the page's time.
    columns
        Panels in a row of the figure; by their number by default.
    """

    panels: Sequence[Curves]
    over: Course | None = None
    columns: int | None = None

    def at(self, kept: Int[np.ndarray, " k"]) -> list[Curves]:
        """The panels at some of the page's frames."""
        return [panel.at(kept) for panel in self.panels]


def mean_curve(
    name: str, trials: Float[np.ndarray, "n t"], stroke: int | None = None, factor: float = 1.0, count: bool = True
) -> Curve:
    """Mean of trials as a line, mean ± SD (n - 1) as a band; a single trial has no band. NaN is a missing sample.

    Parameters
    ----------
    factor
        What 1 of the trials' unit is in the panel's.
    count
        The name goes on with what is drawn and how many trials there are: "n = 3–5" where some samples are missing.
    """
    known = np.isfinite(trials).sum(axis=0)
    if known.max(initial=0) == 0:
        raise ValueError(f"{name!r}: every sample is NaN")
    mean, sd = (factor * each for each in mean_and_sd(trials))
    least, most = int(known.min()), int(known.max())
    words = f"n = {most}" if least == most else f"n = {least}–{most}"
    if count:
        name = f"{name}, mean ± SD ({words})" if most > 1 else f"{name} ({words})"
    lower, upper = (mean - sd, mean + sd) if most > 1 else (None, None)
    return Curve(name, mean, lower, upper, stroke)

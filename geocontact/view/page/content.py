"""What a page says: answer, reservations, a scene, curves, plans, numbers, tables and words. No HTML here."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.curves.declared import Curve, Curves, Limit, Points, Scale, Shade
from geocontact.view.page.heat import Matrix, StripBlock, Strips
from geocontact.view.page.plan import Length, Mark, Plan, Track
from geocontact.view.page.scene import FaceMap, Linkage, MeshSource, Scene, SceneBody, SetLandmark


@dataclass(frozen=True)
class IntervalRow:
    """A number and the interval that it is known to; NaN where there is none.

    `kind` tells numbers of the same name apart, by a colour of its own.
    """

    name: str
    value: float
    lower: float = float("nan")
    upper: float = float("nan")
    kind: str = ""


@dataclass(frozen=True, eq=False)
class Intervals:
    """Numbers of one unit below each other: as points with whiskers, or as bars from 0.

    Parameters
    ----------
    bars
        Shares and sizes, which are compared with 0.
    words
        What it shows.
    """

    title: str
    unit: str
    intervals: Sequence[IntervalRow]
    bars: bool = False
    words: str = ""


_LINK = re.compile(r"([\w-][\w.-]*/)*[\w-][\w.-]*|", re.ASCII)
IN_THE_DARK = {b"#ffffff": b"#1d2126", b"#000000": b"#e8eaed"}
"""White and black of a drawing in dark surroundings: the page's own card and ink."""
LETTERS = b"<style>text { fill: #e8eaed }</style>"
DRAWN_IN = 12  # colours of a line drawing at most; more are those of a scale

__all__ = [
    "Choices",
    "Curve",
    "Curves",
    "FaceMap",
    "IntervalRow",
    "Intervals",
    "Length",
    "Limit",
    "Linkage",
    "Mark",
    "Matrix",
    "MeshSource",
    "Page",
    "PageChoice",
    "Picture",
    "Plan",
    "Points",
    "Readout",
    "Row",
    "Scale",
    "Scene",
    "SceneBody",
    "Section",
    "SetLandmark",
    "Shade",
    "Strip",
    "StripBlock",
    "Strips",
    "Table",
    "Track",
    "Words",
]


@dataclass(frozen=True, eq=False)
class Strip:
    """How a result depends on the threshold, for the frame under the cursor and, faintly, over all frames.

    Parameters
    ----------
    thresholds
        Increasing, in mm as shown.
    values
        Result for each frame and threshold, in `unit`.
    current
        The chosen threshold [mm].
    """

    title: str
    thresholds: Float[np.ndarray, " k"]
    values: Float[np.ndarray, "t k"]
    unit: str
    current: float


@dataclass(frozen=True, eq=False)
class Row:
    """One number of the frame under the cursor, a text per frame; a leading hyphen is shown as a minus sign."""

    label: str
    unit: str
    texts: Sequence[str]


@dataclass(frozen=True, eq=False)
class Readout:
    """The numbers of the frame under the cursor, as given by the caller."""

    rows: Sequence[Row]
    title: str = "This frame"


@dataclass(frozen=True, eq=False)
class Table:
    """A table of texts; `folded` ones, such as the inputs with their hashes, are opened by the reader.

    `links` are paths from the page, one for each row, "" for none: the first cell leads there.
    """

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    folded: bool = False
    links: Sequence[str] = ()

    def __post_init__(self) -> None:
        if self.links and len(self.links) != len(self.rows):
            raise ValueError(f"{len(self.links)} links for {len(self.rows)} rows")
        if odd := next((link for link in self.links if not _LINK.fullmatch(link)), None):
            raise ValueError(f"{odd!r} is not a path from the page")


@dataclass(frozen=True, eq=False)
class Picture:
    """A drawing that does not change over time, with what it shows in words.

    `svg` is shown as an image: nothing in it can run or load anything. `wide` ones take the page's whole width, and
    scroll on a phone.
    """

    title: str
    words: str
    svg: bytes
    wide: bool = False

    @property
    def base64(self) -> str:
        """The drawing as text."""
        return b64encode(self.svg).decode("ascii")

    @property
    def light(self) -> bool:
        """It holds a colour scale: its colours stay in dark surroundings, so that they mean what its words say."""
        fills = set(re.findall(rb"fill: (#[0-9a-f]{6})", self.svg))
        return b"<image" in self.svg or len(fills) > DRAWN_IN

    @property
    def dark_base64(self) -> str:
        """The drawing with a dark ground, light lines and letters, and all other colours as they are."""
        drawn = re.sub(rb"\b(fill|stroke): (#ffffff|#000000)", lambda m: m[1] + b": " + IN_THE_DARK[m[2]], self.svg)
        return b64encode(re.sub(rb"(<svg\b[^>]*>)", rb"\1" + LETTERS, drawn, count=1)).decode("ascii")


@dataclass(frozen=True, eq=False)
class Words:
    """Paragraphs under a title."""

    title: str
    paragraphs: Sequence[str]


Section = Scene | Curves | Strip | Plan | Intervals | Strips | Matrix | Readout | Picture | Table | Words


@dataclass(frozen=True, eq=False)
class PageChoice:
    """What a page says when its reader chooses so, such as another threshold.

    Parameters
    ----------
    name
        What is chosen: "1 mm".
    headline, facts
        As those of the page.
    instead
        Sections by the place among the page's sections that they take.
    threshold
        Contour drawn bold [m]; one of the scene's.
    """

    name: str
    headline: Sequence[str]
    facts: Sequence[tuple[str, str]]
    instead: Mapping[int, Section]
    threshold: float | None = None


@dataclass(frozen=True, eq=False)
class Choices:
    """What can be chosen (`label`: "threshold"), what the page itself shows (`own`: "4 mm"), and the others."""

    label: str
    own: str
    others: Sequence[PageChoice]


@dataclass(frozen=True, eq=False)
class Page:
    """Everything on one page.

    The first screen holds the headline, the reservations, the facts, and the picture that shows the answer: the scene,
    or else the first curves, plan, intervals, strips, matrix or drawing of the sections.

    Parameters
    ----------
    time, time_label
        Along what the frames follow each other: "time [s]", "cycle [%]", "angle [deg]".
    headline
        The answer in sentences; the first one is set large.
    facts
        Label and value of the few numbers that belong to the answer, one row of them.
    reservations
        What changes how the answer is to be read, each one line.
    start_frame
        Frame shown first: its index in `time`, from 0. By default where the first curve is farthest from zero, of the
        frames in which most curves are known; the first one of a page without curves.
    sections
        In reading order, at most one of them a `Scene`.
    numbers, total
        Number of each frame in the whole motion, counted from 1, and how many frames that has: what the page calls
        them where it holds a part of them. None: 1, 2, … and as many as there are times.
    plays
        Something runs along the frames: a player is offered. False for bins, levels and cases, where curves are read
        by pointing at them.
    choices
        Other readings of the same result.
    answers
        Pictures from the one of the first screen on that show the answer together: the first on the left, the others
        beside it.
    """

    title: str
    subtitle: str
    time: Float[np.ndarray, " t"]
    time_label: str
    headline: Sequence[str] = ()
    facts: Sequence[tuple[str, str]] = ()
    reservations: Sequence[str] = ()
    start_frame: int | None = None
    sections: Sequence[Section] = field(default_factory=tuple)
    numbers: Int[np.ndarray, " shown"] | None = None
    total: int | None = None
    plays: bool = True
    choices: Choices | None = None
    answers: int = 1

    def __post_init__(self) -> None:
        frames = len(self.time)
        if not 0 <= self.opening < frames:
            raise ValueError(f"start_frame is {self.start_frame}, expected one of the {frames} frames")
        if not np.isfinite(self.time).all():
            raise ValueError("time must be finite in every frame")
        if self.answers > 1 and not all(isinstance(self.sections[k], Picture) for k in self.leads):
            raise ValueError(f"answers: the {self.answers} sections that show the answer are not all pictures")
        self._check_numbers()
        if sum(isinstance(section, Scene) for section in self.sections) > 1:
            raise ValueError("a page holds one Scene; put the bodies into it or write two pages")
        others = () if self.choices is None else self.choices.others
        instead = [section for choice in others for section in choice.instead.values()]
        for name, length in _lengths([*self.sections, *instead]):
            if length != frames:
                raise ValueError(f"{name}: {length} frames, expected the {frames} of the page's time")

    @property
    def opening(self) -> int:
        """Index of the frame shown first."""
        return peak(self.sections) if self.start_frame is None else self.start_frame

    @property
    def leads(self) -> range:
        """Places of the sections that show the answer on the first screen; none where there is no picture."""
        for kinds in (Scene, (Curves, Plan, Intervals, Strips, Matrix, Picture)):
            for k, section in enumerate(self.sections):
                if isinstance(section, kinds):
                    return range(k, k + self.answers)
        return range(0)

    def placed(self) -> list[tuple[str, int, int | None, Section]]:
        """Every section with its name on the page, its place, and the choice it belongs to (None: any)."""
        others = () if self.choices is None else self.choices.others
        found: list[tuple[str, int, int | None, Section]] = []
        for k, section in enumerate(self.sections):
            instead = [(c + 1, other.instead[k]) for c, other in enumerate(others) if k in other.instead]
            found.append((f"section-{k}", k, 0 if instead else None, section))
            found += [(f"section-{k}-choice-{c}", k, c, other) for c, other in instead]
        return found

    def _check_numbers(self) -> None:
        frames = len(self.time)
        total = frames if self.total is None else self.total
        numbers = np.arange(1, frames + 1) if self.numbers is None else self.numbers
        if len(numbers) != frames:
            raise ValueError(f"numbers: {len(numbers)} frames, expected the {frames} of the page's time")
        if numbers[0] < 1 or (np.diff(numbers) <= 0).any():
            raise ValueError("numbers must count up from 1 or later")
        if numbers[-1] > total:
            raise ValueError(
                f"numbers end at {numbers[-1]} of {total} frames; pass total, the frames of the whole motion"
            )


def peak(sections: Sequence[Section]) -> int:
    """Where the first curve over the page's time is farthest from zero, of the frames in which most are known."""
    panels = [each for each in sections if isinstance(each, Curves) and each.over is None]
    curves = [curve.values for panel in panels for curve in panel.curves if not curve.thin]
    if not curves or len({len(values) for values in curves}) > 1:  # lengths that differ are refused below
        return 0
    known = np.isfinite(curves).sum(axis=0)
    size = np.where(known == known.max(), np.abs(np.nan_to_num(curves[0])), -1.0)
    return int(np.argmax(size))


def _lengths(sections: Sequence[Section]) -> list[tuple[str, int]]:
    """Name and number of frames of everything that changes over time."""
    found: list[tuple[str, int]] = []
    for section in sections:
        match section:
            case Scene(bodies=bodies, maps=maps, linkages=linkages):
                found += [(f"map {each.name}", len(each.values)) for each in maps]
                found += [(f"poses of {b.name}", len(b.poses)) for b in bodies if b.poses is not None]
                found += [(f"distance of {b.name}", len(b.distance)) for b in bodies if b.distance is not None]
                found += [(f"points of {one.name}", len(one.points)) for one in linkages if len(one.points) > 1]
            case Curves(curves=curves, over=None):
                found += [(f"curve {c.name}", len(c.values)) for c in curves]
                found += [(f"band of {c.name}", len(x)) for c in curves for x in (c.lower, c.upper) if x is not None]
            case Strip(title=title, values=values):
                found.append((f"strip {title}", len(values)))
            case Plan(tracks=tracks):
                found += [(f"track {track.name}", len(track.points)) for track in tracks]
            case Readout(rows=rows):
                found += [(f"readout {row.label}", len(row.texts)) for row in rows]
    return found

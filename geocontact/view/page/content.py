"""What a page says: a scene over time, curves, strips, numbers, tables and words. No HTML here."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.page.scene import Body, FaceMap, Scene

__all__ = [
    "Body",
    "Curve",
    "Curves",
    "FaceMap",
    "Page",
    "Picture",
    "Readout",
    "Row",
    "Scene",
    "Section",
    "Strip",
    "Table",
    "Words",
]


@dataclass(frozen=True, eq=False)
class Curve:
    """One line over time in the unit of its panel, with a band where bounds are known; NaN is a gap."""

    name: str
    values: Float[np.ndarray, " t"]
    lower: Float[np.ndarray, " t"] | None = None
    upper: Float[np.ndarray, " t"] | None = None


@dataclass(frozen=True, eq=False)
class Curves:
    """A panel of curves with one axis."""

    title: str
    unit: str
    curves: Sequence[Curve]


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
    """A table of texts, such as the inputs with their hashes."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True, eq=False)
class Picture:
    """A drawing that does not change over time, with what it shows in words.

    `svg` is shown as an image: nothing in it can run or load anything. `wide` ones take the whole width of the page.
    """

    title: str
    words: str
    svg: bytes
    wide: bool = False

    @property
    def base64(self) -> str:
        """The drawing as text."""
        return b64encode(self.svg).decode("ascii")


@dataclass(frozen=True, eq=False)
class Words:
    """Paragraphs under a title."""

    title: str
    paragraphs: Sequence[str]


Section = Scene | Curves | Strip | Readout | Picture | Table | Words


@dataclass(frozen=True, eq=False)
class Page:
    """Everything on one page.

    Parameters
    ----------
    time, time_label
        Time of each frame and what it is: "time [s]", "cycle [%]". A page of one frame has no slider.
    headline
        Label and value of what must be answered without a click: where, how much, in which frame.
    start_frame
        Frame shown first: its index in `time`, from 0.
    numbers, total
        Number of each frame in the whole motion, counted from 1, and how many frames that has: what the page calls
        them where it holds a part of them. None: 1, 2, … and as many as there are times.
    sections
        In reading order, at most one of them a `Scene`.
    """

    title: str
    subtitle: str
    time: Float[np.ndarray, " t"]
    time_label: str
    headline: Sequence[tuple[str, str]] = ()
    start_frame: int = 0
    sections: Sequence[Section] = field(default_factory=tuple)
    numbers: Int[np.ndarray, " shown"] | None = None
    total: int | None = None

    def __post_init__(self) -> None:
        frames = len(self.time)
        if not 0 <= self.start_frame < frames:
            raise ValueError(f"start_frame is {self.start_frame}, expected one of the {frames} frames")
        if not np.isfinite(self.time).all():
            raise ValueError("time must be finite in every frame")
        self._check_numbers()
        if sum(isinstance(section, Scene) for section in self.sections) > 1:
            raise ValueError("a page holds one Scene; put the bodies into it or write two pages")
        for name, length in _lengths(self.sections):
            if length != frames:
                raise ValueError(f"{name}: {length} frames, expected the {frames} of the page's time")

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


def _lengths(sections: Sequence[Section]) -> list[tuple[str, int]]:
    """Name and number of frames of everything that changes over time."""
    found: list[tuple[str, int]] = []
    for section in sections:
        match section:
            case Scene(bodies=bodies, maps=maps):
                found += [(f"map {each.name}", len(each.values)) for each in maps]
                found += [(f"poses of {b.name}", len(b.poses)) for b in bodies if b.poses is not None]
                found += [(f"distance of {b.name}", len(b.distance)) for b in bodies if b.distance is not None]
            case Curves(curves=curves):
                found += [(f"curve {c.name}", len(c.values)) for c in curves]
                found += [(f"band of {c.name}", len(x)) for c in curves for x in (c.lower, c.upper) if x is not None]
            case Strip(title=title, values=values):
                found.append((f"strip {title}", len(values)))
            case Readout(rows=rows):
                found += [(f"readout {row.label}", len(row.texts)) for row in rows]
    return found

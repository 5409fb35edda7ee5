"""Pages of a result: what the frame adds to each, which frames they show, and the figures that they hold."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.folder import RUN
from geocontact.analyses.frame.record import NO_FIGURES, Record
from geocontact.analyses.frame.warning_kinds import merged
from geocontact.analyses.frame.withheld import is_end, withheld_section
from geocontact.analyses.frame.words import MOST, headline
from geocontact.data.version import VERSION
from geocontact.view.curves.style import save
from geocontact.view.extremes import FRAMES, with_extremes
from geocontact.view.page.content import Page, Picture, Section, Table, Words
from geocontact.view.page.tables import frame_table, inputs_table
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


def save_both(figure: Figure, folder: Path, name: str) -> bytes:
    """Write `name`.png and `name`.svg; returns the drawing that scales, for the page."""
    for ending in ("png", "svg"):
        save(figure, folder / f"{name}.{ending}")
    return (folder / f"{name}.svg").read_bytes()


def drawing(figure: Figure) -> bytes:
    """The drawing that scales, as a page holds it."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "figure.svg"
        save(figure, file)
        return file.read_bytes()


class Drawings(Mapping[str, bytes]):
    """Figures by name as pages hold them, each drawn once, when it is asked for.

    Parameters
    ----------
    figures
        Makes all figures by name.
    """

    def __init__(self, figures: Callable[[], Mapping[str, Figure]]) -> None:
        self._figures = figures
        self._drawn: dict[str, bytes] = {}

    @cached_property
    def figures(self) -> Mapping[str, Figure]:
        """The figures."""
        return self._figures()

    def __getitem__(self, name: str) -> bytes:
        if name not in self._drawn:
            self._drawn[name] = drawing(self.figures[name])
        return self._drawn[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.figures)

    def __len__(self) -> int:
        return len(self.figures)


AGAIN = f"geocontact rerun {RUN}"


def options_table(record: Record) -> Table:
    """Options without the folders of files: a page is passed on, and where its files lay is nobody's business.

    Nor with those that change nothing on the page.
    """
    told = {key: value for key, value in record.options.items() if key not in ("out", NO_FIGURES)}
    given = [(key, _shown(value)) for key, value in told.items() if value not in (None, False, [], ())]
    sizes = _sizes_in_si(record)
    options = [(key, f"{shown} (in SI: {sizes[key]})" if key in sizes else shown) for key, shown in given]
    made = [("geocontact", VERSION), ("command", f"geocontact {record.command}"), ("run again", AGAIN)]
    return Table("How it was made", ("option", "value"), [*made, *options, *record.versions().items()], folded=True)


def _sizes_in_si(record: Record) -> dict[str, str]:
    """Numbers of typed options with their SI unit; names that have their unit with them need none."""
    found = {}
    for key, value in record.in_si.items():
        name, bracket, unit = key.partition(" [")
        numbers = value if isinstance(value, (list, tuple)) else [value]
        if bracket and numbers and all(isinstance(each, (int, float)) for each in numbers):
            found[name] = f"{', '.join(f'{each:.6g}' for each in numbers)} {unit.removesuffix(']')}"
    return found


def _shown(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(_shown(item) for item in value)
    text = str(value)
    return Path(text).name if isinstance(value, Path) or quantities.named_file(text) is not None else text


def thinned(
    count: int, curves: Sequence[Float[np.ndarray, " t"]] = (), always: Iterable[int] = (), most: int = FRAMES
) -> Int[np.ndarray, " k"]:
    """Frames, about `most` of `count` at most: those with the extremes of the curves; every so manieth without curves.

    `always` are frames that are kept besides.
    """
    if len(curves):
        return with_extremes(count, curves, most, always)
    return np.unique([*range(0, count, -(-count // most)), *always]).astype(np.int64)


INPUTS, OPTIONS = Table("Input files", (), ()), Table("How it was made", (), ())
"""Stand in a page's sections where its input files and its options are to be shown, which else end it."""

LARGEST_FILE = 5_000_000  # bytes; larger pages are thinned out until they fit


@dataclass(frozen=True)
class Thinned:
    """A page of a long recording that shows fewer frames until its file is small enough.

    Parameters
    ----------
    of
        The page with about so many frames at most.
    most
        Frames at first.
    fewest
        Frames below which it is thinned no further.
    """

    of: Callable[[int], Page]
    most: int
    fewest: int = 21


def finished(page: Page, record: Record, folder: str, reservations: Sequence[str]) -> Page:
    """The page of a sub-folder ("": of the whole) with the files that went into it, options, and reservations first."""
    inputs = [entry for entry in record.inputs if not folder or entry.get("folder", folder) == folder]
    places = (INPUTS, inputs_table(inputs)), (OPTIONS, options_table(record))
    sections = list(page.sections)
    for place, table in places:
        at = next((k for k, section in enumerate(sections) if section is place), len(sections))
        sections[at : at + 1] = [table]
    facts = list(page.facts)
    if record.judged:
        sections = [withheld_section(each) for each in sections]
        facts = [fact for fact in facts if not is_end(fact[0])]
    first = headline([record.judged]) if record.judged else ()
    told = tuple(line for line in page.headline if line not in first)
    every = [*reservations, *page.reservations]
    kinds = merged(every)
    if len(kinds) < len(every):
        sections.append(Table("All warnings", ("warning",), [(line,) for line in every], folded=True))
    return replace(page, facts=facts, sections=tuple(sections), reservations=tuple(kinds), headline=(*first, *told))


def write_finished(
    page: Page | Thinned,
    file: Path,
    record: Record,
    folder: str,
    reservations: Sequence[str],
    largest: int | None = None,
) -> None:
    """Write the finished page, thinned out until it has `largest` bytes at most, as far as it can be."""
    largest = LARGEST_FILE if largest is None else largest
    most = page.most if isinstance(page, Thinned) else 0
    while True:
        one = page.of(most) if isinstance(page, Thinned) else page
        size = write_page(finished(one, record, folder, reservations), file)
        most = min(most, len(one.time)) // 2
        if size <= largest or not isinstance(page, Thinned) or most < page.fewest:
            return


def plain_page(title: str, record: Record, figure: bytes | None, tables: Mapping[str, pd.DataFrame]) -> Page:
    """The answer in sentences, figure and tables, for analyses that have nothing to show over time."""
    sections: list[Section] = []
    if figure is not None:
        sections.append(Picture("Figure", "", figure, wide=True))
    if len(record.sentences) > MOST:
        sections.append(Words("What was found", list(record.sentences)))
    sections += [frame_table(name, table) for name, table in tables.items()]
    return Page(
        title,
        f"geocontact {record.command}",
        np.zeros(1),
        "",
        headline=headline(record.sentences),
        sections=tuple(sections),
    )

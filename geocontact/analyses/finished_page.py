"""A page as every analysis leaves it: with reservations, input files and options, and not too large."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.figure_files import drawing
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import MOST, headline
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Page, Picture, Section, Table, Words
from geocontact.view.page.tables import frame_table, inputs_table
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

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
    return replace(page, sections=tuple(sections), reservations=(*reservations, *page.reservations))


def write_finished(page: Page | Thinned, file: Path, record: Record, folder: str, reservations: Sequence[str]) -> None:
    """Write the finished page, thinned out as far as it has to be."""
    most = page.most if isinstance(page, Thinned) else 0
    while True:
        one = page.of(most) if isinstance(page, Thinned) else page
        size = write_page(finished(one, record, folder, reservations), file)
        most = min(most, len(one.time)) // 2
        if size <= LARGEST_FILE or not isinstance(page, Thinned) or most < page.fewest:
            return


def plain_page(title: str, record: Record, figure: Figure | None, tables: Mapping[str, pd.DataFrame]) -> Page:
    """The answer in sentences, figure and tables, for analyses that have nothing to show over time."""
    sections: list[Section] = []
    if figure is not None:
        sections.append(Picture("Figure", "", drawing(figure), wide=True))
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

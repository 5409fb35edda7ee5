"""A page of figure, numbers and inputs, for analyses that have nothing to show over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.figure_files import drawing
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import MOST, headline
from geocontact.analyses.result import Result
from geocontact.view.page.content import Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table, inputs_table
from geocontact.view.page.write import write_page


def write_plain_page(result: Result, title: str, file: Path) -> None:
    """The answer in sentences, reservations, figure, tables, inputs with hashes, options."""
    sections: list[Section] = []
    figure = result.figure()
    if figure is not None:
        sections.append(Picture("Figure", "", drawing(figure), wide=True))
    if len(result.sentences) > MOST:
        sections.append(Words("What was found", list(result.sentences)))
    for name, table in result.tables().items():
        sections.append(frame_table(name, table))
    sections += [inputs_table(result.record.inputs), options_table(result.record)]
    page = Page(
        title,
        f"geocontact {result.record.command}",
        np.zeros(1),
        "",
        headline=headline(result.sentences),
        reservations=result.warnings,
        sections=tuple(sections),
    )
    write_page(page, file)

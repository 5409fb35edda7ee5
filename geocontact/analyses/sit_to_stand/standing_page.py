"""The frame that the pages of standing up share: a player over the movement, inputs, options, words."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.standing_scene import FRAMES
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import inputs_table
from geocontact.view.page.write import write_page


def write_motion_page(
    path: Path,
    record: Record,
    titles: tuple[str, str],
    sections: Sequence[Section],
    words: Sequence[str],
    facts: Sequence[tuple[str, str]] = (),
) -> int:
    """Write the self-contained page, title and subtitle first; returns its size in bytes."""
    end: list[Section] = [
        inputs_table(record.inputs),
        options_table(record),
        Words("What the numbers mean", [*words, NOT_A_DEVICE]),
    ]
    title, subtitle = titles
    page = Page(
        title=title,
        subtitle=subtitle,
        time=np.linspace(0.0, 100.0, FRAMES),
        time_label="part of the movement [%]",
        headline=headline(record.sentences),
        facts=list(facts),
        reservations=tuple(record.warnings),
        sections=(*sections, *end),
    )
    return write_page(page, path)

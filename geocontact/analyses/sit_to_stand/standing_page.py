"""What the pages of standing up share: a player over the movement, inputs, options, words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.sit_to_stand.standing_scene import FRAMES
from geocontact.view.page.content import Page, Section, Words


def motion_page(
    titles: tuple[str, str],
    sentences: Sequence[str],
    sections: Sequence[Section],
    words: Sequence[str],
    facts: Sequence[tuple[str, str]] = (),
) -> Page:
    """Title and subtitle, what was found as the headline, sections, and what the numbers mean."""
    title, subtitle = titles
    return Page(
        title=title,
        subtitle=subtitle,
        time=np.linspace(0.0, 100.0, FRAMES),
        time_label="part of the movement [%]",
        headline=headline(sentences),
        facts=list(facts),
        sections=(*sections, INPUTS, OPTIONS, Words("What the numbers mean", [*words, NOT_A_DEVICE])),
    )

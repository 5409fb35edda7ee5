"""What the pages of an elbow have in common."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.write import write_page

FRAMES = 601  # samples that a page shows at most
LAW = (
    "One rigid link, one spring along the limb, both axes fixed: no friction, no slip of the cuff, no give of the "
    "upper arm's fixation, no axis that wanders. What differs between donnings is in the residuals, and intervals by "
    "stretches of time do not hold it: look at the trials that were not used."
)
NOT_IN_THE_NUMBERS = Words("What the numbers do not contain", [LAW, NOT_A_DEVICE])


def write_elbow_page(
    path: Path,
    title: str,
    subtitle: str,
    time: Float[np.ndarray, " t"],
    label: str,
    facts: Sequence[tuple[str, str]],
    sections: Sequence[Section],
    record: Record,
    plays: bool = True,
) -> int:
    """Write the page with the answer and the reservations of `record`; returns its size in bytes."""
    page = Page(
        title,
        subtitle,
        time,
        label,
        headline=headline(record.sentences, most=2),
        facts=facts,
        reservations=tuple(record.warnings),
        sections=tuple(sections),
        plays=plays,
    )
    return write_page(page, path)

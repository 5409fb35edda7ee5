"""What pages and figures of an elbow have in common."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import spelled
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.view.curves.quantity import Quantity
from geocontact.view.page.content import Page, Section, Words

ANGLE = "exoskeleton angle β [°]"
CONSTRAINT = Quantity("constraint force", "N")


FACTS = 5  # at most
FRAMES = 601  # samples that a page shows at most
LAW = (
    "One rigid link, one spring along the limb, both axes fixed: no friction, no slip of the cuff, no turn of the "
    "upper arm's fixation and, unless c is known or free, no give of it, no axis that wanders. What differs between "
    "donnings is in the residuals, and intervals by stretches of time do not hold it: look at the trials that were "
    "not used."
)
NOT_IN_THE_NUMBERS = Words("What the numbers do not contain", [LAW, NOT_A_DEVICE])


def elbow_page(
    title: str,
    subtitle: str,
    time: Float[np.ndarray, " t"],
    label: str,
    answer: Sequence[str],
    facts: Sequence[tuple[str, str]],
    sections: Sequence[Section],
    start_frame: int | None = None,
) -> Page:
    """The page with the answer, in the words of `record`.

    `start_frame` is that of bins of the angle; None where the frames run in time, from the peak.
    """
    return Page(
        title,
        subtitle,
        time,
        label,
        headline=[spelled(line) for line in answer],
        facts=facts[:FACTS],
        sections=tuple(sections),
        start_frame=start_frame,
        plays=start_frame is None,
    )

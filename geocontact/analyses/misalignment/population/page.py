"""The page of a population: how large the force gets in how many people, and what that depends on."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.design.page import MODEL
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

FIGURE = (
    "Left: density of the largest |F| over the range of angles. Right: probability that it is above a force; the band "
    "is what the number of samples leaves open."
)
DRAWN = (
    "The people are synthetic: drawn from the distributions in the description, which are as good as what they were "
    "taken from. Intervals tell the error of drawing a finite number of them, nothing else. Samples whose limb or link "
    "comes to a pole or a fold have no force; they count as beyond every force."
)
INFLUENCE = (
    "Shares of the variance (Sobol): first, what knowing the factor would take away; total, what would be left if all "
    "others were known. They need independent factors and a force for every sample. Coefficients of ranks see what "
    "rises or falls throughout, those of the distance from the median what acts either way, as offsets do."
)


def write_population_report(
    path: Path,
    title: str,
    levels: Float[np.ndarray, " k"],
    exceedance: Sequence[IntervalEstimate],
    limit: float,
    drawing: bytes,
    tables: Sequence[Table],
    warnings: Sequence[str],
) -> int:
    """Write the self-contained page; returns its size in bytes.

    Parameters
    ----------
    levels, exceedance
        Forces [N] and the probability of more; the slider of the page goes along them.
    limit
        Force [N] that it starts at.
    drawing
        The figure (SVG).
    tables
        Results first; the first one's rows make the headline.
    """
    value, lower, upper = (np.array([getattr(one, end) for one in exceedance]) for end in ("value", "lower", "upper"))
    readout = [
        Row(name, "%", [f"{100.0 * each:.4f}" for each in column])
        for name, column in (("probability of more", value), ("lower end, 95 %", lower), ("upper end, 95 %", upper))
    ]
    sections: list[Section] = [
        Readout(readout, "At this force"),
        Curves(
            "Probability of more", "%", [Curve("share of the samples", *(100.0 * c for c in (value, lower, upper)))]
        ),
        tables[0],
        Picture("Distribution of the largest force", FIGURE, drawing, wide=True),
        *tables[1:],
        Words("How to read where the spread comes from", [INFLUENCE]),
        Words("What the numbers do not contain", [DRAWN, MODEL, NOT_A_DEVICE]),
    ]
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    page = Page(
        title=title,
        subtitle="Exoskeleton beside a joint: forces over a population",
        time=levels,
        time_label="force [N]",
        headline=[(row[0], row[1]) for row in tables[0].rows],
        start_frame=int(np.argmin(np.abs(levels - limit))),
        sections=tuple(sections),
    )
    return write_page(page, path)

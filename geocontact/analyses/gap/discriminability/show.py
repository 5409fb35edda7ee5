"""What trials show, in figures and on a page: which effects they separate, and from which size on they are seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.gap.discriminability.answer import confusion_sentences, size_words
from geocontact.analyses.gap.nats import ODDS
from geocontact.gap.identifiability.detectability import Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import reach_of, rest_of
from geocontact.gap.levels import APART
from geocontact.view.curves.diagnosis_answers import (
    SEPARABILITY_MOST,
    EffectVisibility,
    detectability_figure,
    separability_figure,
)
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Matrix, Page, Table, Words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MATRIX = (
    "A row is an effect that is there, a column a model that is fitted instead, base parameters refitted. The number "
    "is by how many nats the right model is ahead: coloured cells are pairs that these trials separate, pale ones "
    f"pairs that they do not (less than {APART:g} nats). The column none is the base model alone: what is visible of "
    f"the effect. {ODDS}"
)
SIZES = "Smallest amplitudes that the diagnosis is predicted to see in four of five repetitions of these trials"
MOST_PRINTED = 99.5
"""Nats above which a cell of the matrix says no more than that."""
LIMITS = (
    "Noise, deviations of trials and noise of the inputs are those that the diagnosis of this case estimated, taken as "
    "known. Each effect has the form of its candidate, its shape parameter where a search for it sets out. That "
    "something is seen does not say that the right effect is named: see the matrix."
)


def confusion_figures(found: Discriminability) -> dict[str, Figure]:
    """Matrix and bars, by the name of their files."""
    return {
        "separability": matrix_figure(found),
        "detectability": detectability_figure([_visibility(one) for one in found.detectabilities]),
    }


def matrix_figure(found: Discriminability) -> Figure:
    """Nats by which each effect is ahead of each other one."""
    labels, matrix = table(found.separations)
    return separability_figure(labels, ["none", *labels], matrix)


def _visibility(one: Detectability) -> EffectVisibility:
    return EffectVisibility(one.candidate.label, *_share_and_words(one))


def _share_and_words(one: Detectability) -> tuple[float | None, str]:
    """Smallest amplitude as a share of the plausible range, and with its unit."""
    if one.smallest is None:
        return None, "not to be seen"
    share = abs((one.smallest - rest_of(one.candidate)) / reach_of(one.candidate, one.candidate.starts[0]))
    return share, size_words(one)


def confusion_page(title: str, found: Discriminability) -> Page:
    """The self-contained page, before it becomes a file.

    Parameters
    ----------
    title
        With the name of the case.
    found
        What was found.
    """
    sentences = confusion_sentences(found)
    seen = [one for one in found.detectabilities if one.smallest is not None]
    said = [f"{s[0].upper()}{s[1:]}." for s in sentences]
    return Page(
        title=title,
        subtitle=f"From which size on, and which of them can be separated; base model {found.ground.system.name}",
        time=np.zeros(1),
        time_label="time [s]",
        headline=headline([sentences[0], *(line for line in sentences if line.startswith("not separable"))], most=2),
        facts=(
            ("Effects that would be seen", f"{len(seen)} of {len(found.detectabilities)}"),
            ("Groups that are not separable", str(len(found.classes))),
        ),
        sections=(
            separation_matrix(found),
            Words("What these trials can detect and separate", said),
            _sizes(found),
            INPUTS,
            OPTIONS,
            Words("What the numbers do not contain", [LIMITS, NOT_A_DEVICE]),
        ),
    )


def separation_matrix(found: Discriminability) -> Matrix:
    """Nats by which each effect is ahead of each model that is fitted instead."""
    labels, nats = table(found.separations)
    shades = np.clip(nats, 0.0, SEPARABILITY_MOST) / SEPARABILITY_MOST
    texts = [[_cell(value) for value in row] for row in nats]
    scale = [f"{SEPARABILITY_MOST * part:g}" for part in (0.0, 0.25, 0.5, 0.75)] + [
        f"{SEPARABILITY_MOST:g} nats or more"
    ]
    corner = "effect that is there ↓, model that is fitted instead →"
    return Matrix(
        "Separation of effects, by pairs", "nats", labels, ["none", *labels], corner, shades, texts, scale, MATRIX
    )


def _cell(nats: float) -> str:
    return "" if np.isnan(nats) else f"{max(nats, 0.0):.0f}" if nats < MOST_PRINTED else ">99"


def _sizes(found: Discriminability) -> Table:
    rows = []
    shares = {one.candidate.label: _share_and_words(one) for one in found.detectabilities}
    by_share = lambda one: np.inf if (share := shares[one.candidate.label][0]) is None else share  # noqa: E731
    for one in sorted(found.detectabilities, key=by_share):
        share, words = shares[one.candidate.label]
        part = "–" if share is None else f"{100.0 * share:.2g} %"
        nats = (_nats(one.at.visible), _nats(one.at.absorbed))
        rows.append((one.candidate.label, one.candidate.parameters[0].name, words, part, *nats))
    header = (
        "effect",
        "parameter",
        "smallest",
        "of its plausible range",
        "visible there [nats]",
        "absorbed there [nats]",
    )
    return Table(SIZES, header, rows)


def _nats(value: float) -> str:
    return number(value, max(value, 10.0))

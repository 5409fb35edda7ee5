"""What trials can tell, in figures and on a page: who is told from whom, from which size on effects are seen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.gap.discriminability.answer import confusion_sentences, size_words
from geocontact.gap.identifiability.detectability import Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import reach_of, rest_of
from geocontact.view.curves.diagnosis_answers import EffectVisibility, detectability_figure, separability_figure
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Page, Picture, Section, Table, Words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MATRIX = (
    "Nats by which an effect (row) beats a model that is fitted instead (column), base parameters refitted. The column "
    "none is the base model alone: what is visible of the effect."
)
SIZES = "Smallest amplitude that the diagnosis is predicted to see in four of five repetitions of these trials."
CAPTIONS = {"separability": ("Separation of effects, by pairs", MATRIX), "detectability": ("What would be seen", SIZES)}
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
    """Nats by which each effect is told from each."""
    labels, matrix = table(found.separations)
    return separability_figure(labels, ["none", *labels], matrix)


def _visibility(one: Detectability) -> EffectVisibility:
    if one.smallest is None:
        return EffectVisibility(one.candidate.label, None, "not to be seen")
    rest = rest_of(one.candidate)
    share = abs((one.smallest - rest) / reach_of(one.candidate, one.candidate.starts[0]))
    return EffectVisibility(one.candidate.label, share, size_words(one))


def confusion_page(title: str, found: Discriminability, drawings: Mapping[str, bytes]) -> Page:
    """The self-contained page, before it becomes a file.

    Parameters
    ----------
    title
        Name of the case.
    found
        What was found.
    drawings
        `confusion_figures` as SVG.
    """
    sentences = confusion_sentences(found)
    sections: list[Section] = [Picture(*CAPTIONS[name], svg, wide=True) for name, svg in drawings.items()]
    sections.append(Words("What these trials can detect and separate", [f"{s[0].upper()}{s[1:]}." for s in sentences]))
    sections += [_sizes(found), INPUTS, OPTIONS, Words("What the numbers do not contain", [LIMITS, NOT_A_DEVICE])]
    seen = sum(one.smallest is not None for one in found.detectabilities)
    return Page(
        title=title,
        subtitle=f"What the trials of a gap case can detect and separate, base model {found.ground.system.name}",
        time=np.zeros(1),
        time_label="time [s]",
        headline=headline(sentences, most=1),
        facts=(
            ("effects that would be seen", f"{seen} of {len(found.detectabilities)}"),
            ("groups that are not separable", str(len(found.classes))),
        ),
        sections=tuple(sections),
    )


def _sizes(found: Discriminability) -> Table:
    rows = [
        (
            one.candidate.label,
            one.candidate.parameters[0].name,
            "–" if one.smallest is None else f"{one.smallest:.4g}".replace("-", "−"),
            one.candidate.parameters[0].unit,
            _nats(one.at.visible),
            _nats(one.at.absorbed),
        )
        for one in found.detectabilities
    ]
    header = ("effect", "parameter", "smallest", "unit", "visible there [nats]", "absorbed there [nats]")
    return Table("Smallest amplitudes", header, rows)


def _nats(value: float) -> str:
    return number(value, max(value, 10.0))

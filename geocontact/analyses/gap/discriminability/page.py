"""The page of what trials can tell: sentences, who is told from whom, from which size on effects are seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.gap.discriminability.words import size_words
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.gap.identifiability.detectability import Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import reach_of, rest_of
from geocontact.view.curves.diagnosis.detectability import Seen, detectability_figure
from geocontact.view.curves.diagnosis.separability import separability_figure
from geocontact.view.curves.text import number
from geocontact.view.page.content import Page, Picture, Section, Table, Words
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MATRIX = (
    "Nats by which an effect (row) beats a model that is fitted instead (column), base parameters refitted. The column "
    "none is the base model alone: what is visible of the effect."
)
SIZES = "Smallest amplitude that the diagnosis is predicted to see in four of five repetitions of these trials."
CAPTIONS = {"separability": ("Who is told from whom", MATRIX), "detectability": ("What would be seen", SIZES)}
LIMITS = (
    "Noise, deviations of trials and noise of the inputs are those that the diagnosis of this case estimated, taken as "
    "known. Each effect has the form of its candidate, its shape parameter where a search for it sets out. That "
    "something is seen does not say that the right effect is named: see the matrix."
)


def confusion_figures(found: Discriminability) -> dict[str, Figure]:
    """Matrix and bars, by the name of their files."""
    labels, matrix = table(found.separations)
    return {
        "separability": separability_figure(labels, ["none", *labels], matrix),
        "detectability": detectability_figure([_seen(one) for one in found.detectabilities]),
    }


def _seen(one: Detectability) -> Seen:
    if one.smallest is None:
        return Seen(one.candidate.label, None, "not to be seen")
    rest = rest_of(one.candidate)
    share = abs((one.smallest - rest) / reach_of(one.candidate, one.candidate.starts[0]))
    return Seen(one.candidate.label, share, size_words(one))


def write_confusion_report(
    path: Path,
    title: str,
    found: Discriminability,
    sentences: Sequence[str],
    drawings: Mapping[str, bytes],
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
) -> int:
    """Write the self-contained page; returns its size in bytes.

    Parameters
    ----------
    path
        HTML file to write.
    title
        Name of the case.
    found, sentences
        What was found, and the same in words.
    drawings
        `confusion_figures` as SVG.
    provenance
        Further tables: inputs with hashes, options, versions.
    warnings
        Reservations that came up on the way.
    """
    sections: list[Section] = [Words("What these trials can tell", [f"{s[0].upper()}{s[1:]}." for s in sentences])]
    sections += [Picture(*CAPTIONS[name], svg, wide=True) for name, svg in drawings.items()]
    sections += [_sizes(found), *provenance, Words("What the numbers do not contain", [LIMITS, NOT_A_DEVICE])]
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    seen = sum(one.smallest is not None for one in found.detectabilities)
    page = Page(
        title=title,
        subtitle=f"What the trials of a gap case can tell, base model {found.ground.system.name}",
        time=np.zeros(1),
        time_label="time [s]",
        headline=(
            ("effects that would be seen", f"{seen} of {len(found.detectabilities)}"),
            ("groups not to be told apart", str(len(found.classes))),
        ),
        sections=tuple(sections),
    )
    return write_page(page, path)


def _sizes(found: Discriminability) -> Table:
    rows = [
        (
            one.candidate.label, one.candidate.parameters[0].name,
            "–" if one.smallest is None else f"{one.smallest:.4g}".replace("-", "−"), one.candidate.parameters[0].unit,
            _nats(one.at.visible), _nats(one.at.absorbed),
        )
        for one in found.detectabilities
    ]  # fmt: skip
    header = ("effect", "parameter", "smallest", "unit", "visible there [nats]", "absorbed there [nats]")
    return Table("Smallest amplitudes", header, rows)


def _nats(value: float) -> str:
    return number(value, max(value, 10.0))

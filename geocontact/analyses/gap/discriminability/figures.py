"""The figures of what trials can tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geocontact.analyses.gap.discriminability.words import size_words
from geocontact.gap.identifiability.detectability import Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import reach_of, rest_of
from geocontact.view.curves.diagnosis.detectability import EffectVisibility, detectability_figure
from geocontact.view.curves.diagnosis.separability import separability_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def confusion_figures(found: Discriminability) -> dict[str, Figure]:
    """Matrix and bars, by the name of their files."""
    return {
        "separability": matrix_figure(found),
        "detectability": detectability_figure([_seen(one) for one in found.detectabilities]),
    }


def matrix_figure(found: Discriminability) -> Figure:
    """Nats by which each effect is told from each."""
    labels, matrix = table(found.separations)
    return separability_figure(labels, ["none", *labels], matrix)


def _seen(one: Detectability) -> EffectVisibility:
    if one.smallest is None:
        return EffectVisibility(one.candidate.label, None, "not to be seen")
    rest = rest_of(one.candidate)
    share = abs((one.smallest - rest) / reach_of(one.candidate, one.candidate.starts[0]))
    return EffectVisibility(one.candidate.label, share, size_words(one))
